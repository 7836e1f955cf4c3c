#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <optional>

#include "app/commands.hpp"
#include "base/error.hpp"
#include "base/nearest_name.hpp"

namespace {

using namespace riven;
using namespace riven::app;

/// Options that every command that reads a case has.
void add_case_options(CLI::App& command, Options& options, const char* target) {
  command.add_option("case", options.target, target);
  command.add_option("--set", options.set, "Override a key of the case: path.to.key=value (may be repeated)")
      ->type_size(1)
      ->allow_extra_args(false);
}

void add_run_options(CLI::App& command, Options& options) {
  command.add_option("--threads", options.threads, "Number of threads (default: all cores)")
      ->check(CLI::Range(1, 1024));
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

/// What is wrong with the first word, if it is no command.
std::optional<std::string> wrong_command(const CLI::App& program, const std::string& word) {
  const std::vector<std::string> names = command_names(program);
  if (word.starts_with('-') || std::find(names.begin(), names.end(), word) != names.end())
    return std::nullopt;
  if (word.ends_with(".toml"))
    return fmt::format("{}: expected a command first; did you mean \"riven run {}\"?", word, word);
  return fmt::format("{}: unknown command; expected one of {}{}", word, listed(names),
                     did_you_mean(word, names));
}

/// One line in Riven's words about arguments that do not fit.
std::string wrong_arguments(const CLI::App& program, const CLI::ParseError& error) {
  const auto chosen = program.get_subcommands();
  const std::string command = chosen.empty() ? "riven" : "riven " + chosen.front()->get_name();
  std::string what = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr && !chosen.empty()) {
    std::vector<std::string> options;
    for (const CLI::Option* option : chosen.front()->get_options())
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    const std::vector<std::string> extras = program.remaining(true);
    const auto dashed = std::find_if(extras.begin(), extras.end(),
                                     [](const std::string& word) { return word.starts_with('-'); });
    what = dashed != extras.end()
               ? fmt::format("{}: unknown option{}", *dashed, did_you_mean(*dashed, options))
               : fmt::format("{}: one argument too many", extras.empty() ? what : extras.front());
  }
  return fmt::format("{}; \"{} --help\" shows what is expected", what, command);
}

/// Prints the help of a command, or the overview of all.
int help(const CLI::App& program, const std::string& overview, const std::string& command) {
  if (const auto wrong = command.empty() ? std::nullopt : wrong_command(program, command))
    throw InputError(*wrong);
  fmt::print("{}", command.empty() ? overview : program.get_subcommand(command)->help("riven"));
  return kDone;
}

/// A command is not done as long as what it printed has not arrived.
int delivered(int code) {
  if (std::fflush(stdout) == 0) return code;
  fmt::print(stderr, "error: cannot write to standard output: {}\n", std::strerror(errno));
  return kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Riven: how rubber, glass and shells deform and break, by peridynamics", "riven");
  program.require_subcommand(1);
  program.set_version_flag("--version", "riven " RIVEN_VERSION);
  Options options;
  CompareOptions comparison;
  bool brief = false, markdown = false;
  int code = kDone;
  const auto on = [&](CLI::App* command, std::function<int()> action) {
    command->callback([&code, action = std::move(action)] { code = guarded(action); });
    return command;
  };

  CLI::App* run_command =
      on(program.add_subcommand("run", "Run a case: riven run CASE.toml"), [&] { return run(options); });
  add_case_options(*run_command, options, "Case file, or the name of a shipped case (riven cases)");
  add_run_options(*run_command, options);
  run_command->add_option("-o,--output", options.output, "Result folder (default: results/<case>)");
  run_command->add_flag("--force", options.force, "Replace an existing result");
  run_command->get_option("case")->required();

  CLI::App* check_command =
      on(program.add_subcommand("check", "Check a case and print what it means, in SI units"),
         [&] { return check(options); });
  add_case_options(*check_command, options, "Case file, or the name of a shipped case");
  add_run_options(*check_command, options);
  check_command->get_option("case")->required();

  on(program.add_subcommand("cases", "List the cases that ship with Riven"), [] { return cases(); });

  CLI::App* verify_command =
      on(program.add_subcommand("verify", "Run shipped cases and hold them against their references"),
         [&] { return verify(options, brief); });
  add_case_options(*verify_command, options, "Topic or case (default: all)");
  add_run_options(*verify_command, options);
  verify_command->add_flag("--short", brief, "Run the short variants of cases that have one");

  CLI::App* compare_command =
      on(program.add_subcommand("compare", "Hold a result against reference points or a history"),
         [&] { return compare(comparison); });
  compare_command->add_option("dir", comparison.folder, "Result folder")->required();
  compare_command
      ->add_option("reference", comparison.reference,
                   "CSV file: X_m, Y_m, ux_m, uy_m, and lambda, stretch, t_s or time")
      ->required();
  compare_command->add_option(
      "--exclude-within", comparison.exclude_within,
      "Leave out points nearer than this to an edge of a defect: \"15 mm\", \"1 horizon\"");
  compare_command->add_option("--tolerance", comparison.tolerance,
                              "Exit with 1 when a relative L2 deviation is above: 1%");
  compare_command->add_option("--history", comparison.history,
                              "Compare a column of history.csv instead: metric=column");
  compare_command->add_flag("--json", comparison.json, "Print JSON");

  CLI::App* schema_command = on(program.add_subcommand("schema", "Print the JSON Schema of the case format"),
                                [&] { return schema(markdown); });
  schema_command->add_flag("--markdown", markdown, "Print the reference page instead");

  on(program.add_subcommand("version", "Print the version"), [] {
    fmt::print("riven {}\n", RIVEN_VERSION);
    return static_cast<int>(kDone);
  });

  std::string topic, overview;
  on(program.add_subcommand("help", "Explain a command"), [&] {
    return help(program, overview, topic);
  })->add_option("command", topic, "The command");

  overview = program.help();      // once a command is chosen, this gives the command's own
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files shows as a full disk does, with a message
  if (argc < 2) {
    fmt::print(stderr, "{}", overview);
    return kWrongInput;
  }
  if (const auto wrong = wrong_command(program, argv[1])) {
    fmt::print(stderr, "error: {}\n", *wrong);
    return kWrongInput;
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return program.exit(asked);
  } catch (const CLI::ParseError& error) {
    fmt::print(stderr, "error: {}\n", wrong_arguments(program, error));
    return kWrongInput;
  }
  return delivered(code);
}
