#include "app/child_run.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>

#include "base/error.hpp"

namespace riven::app {

namespace {

/// Becomes the program. Between fork and exec only what is safe in a program with threads: system calls.
[[noreturn]] void become(char* const* words, int log, pid_t parent) {
  // Its own group: an interrupt from the keyboard reaches the sweep alone, which passes it on. And a sweep
  // that is killed leaves no runs behind; posix_spawn could not arrange for that.
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(1);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  // By this name a program that was replaced meanwhile still starts.
  ::execv("/proc/self/exe", words);
  constexpr std::string_view kProblem = "error: cannot start the program again\n";
  static_cast<void>(!::write(STDERR_FILENO, kProblem.data(), kProblem.size()));
  ::_exit(1);
}

}  // namespace

ChildRun::ChildRun(const std::vector<std::string>& words, const std::filesystem::path& log) {
  std::vector<std::string> texts{"riven"};
  texts.insert(texts.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  const int output = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (output < 0) throw RunError(fmt::format("cannot write {}: {}", log.string(), std::strerror(errno)));
  const pid_t parent = ::getpid();
  process_ = ::fork();
  if (process_ == 0) become(pointers.data(), output, parent);
  const int problem = errno;
  ::close(output);
  if (process_ < 0) throw RunError(fmt::format("cannot start a run: {}", std::strerror(problem)));
}

std::optional<int> ChildRun::ended() const {
  int status = 0;
  if (::waitpid(process_, &status, WNOHANG) != process_) return std::nullopt;
  constexpr int kSignalled = 128;
  return WIFEXITED(status) ? WEXITSTATUS(status) : kSignalled + WTERMSIG(status);
}

void ChildRun::interrupt() {
  if (asked_to_stop_) return;
  asked_to_stop_ = true;
  ::kill(process_, SIGINT);
}

double ChildRun::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}  // namespace riven::app
