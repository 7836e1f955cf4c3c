#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <new>

#include "app/commands.hpp"
#include "base/error.hpp"

namespace riven::app {

int guarded(const std::function<int()>& command) {
  try {
    return command();
  } catch (const InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return kWrongInput;
  } catch (const std::filesystem::filesystem_error& error) {
    fmt::print(stderr, "error: {}: {}\n", error.path1().string(), error.code().message());
    return kWrongInput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: not enough memory; try a larger spacing (riven check estimates the need)\n");
    return kFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return kFailed;
  }
}

}  // namespace riven::app
