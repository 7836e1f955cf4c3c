// What the leak check of sanitized programs is told; it looks for these functions by name.

extern "C" {

const char* __lsan_default_suppressions() {
  return "leak:libfontconfig.so\n";  // cairo's: it keeps what it read of the fonts until the process ends
}

const char* __lsan_default_options() {
  return "print_suppressions=0";  // tests read what the program prints
}
}
