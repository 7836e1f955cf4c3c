#include <cstdio>

int main() {
  std::puts("riven " RIVEN_VERSION);
  return 0;
}
