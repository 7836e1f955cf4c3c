#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/commands.hpp"
#include "base/error.hpp"

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
  command.add_option("--threads", options.threads, "Number of threads (default: all cores)")->check(CLI::PositiveNumber);
}

int guarded(const std::function<int()>& command) {
  try {
    return command();
  } catch (const InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return kWrongInput;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: not enough memory; try a coarser spacing (riven check estimates the need)\n");
    return kFailed;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return kFailed;
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Riven: how rubber, glass and shells deform and break, by peridynamics", "riven");
  program.require_subcommand(1);
  Options options;
  CompareOptions comparison;
  bool brief = false, markdown = false;
  int code = kDone;
  const auto on = [&](CLI::App* command, std::function<int()> action) {
    command->callback([&code, action = std::move(action)] { code = guarded(action); });
    return command;
  };

  CLI::App* run_command = on(program.add_subcommand("run", "Run a case: riven run CASE.toml"), [&] { return run(options); });
  add_case_options(*run_command, options, "Case file, or the name of a shipped case (riven cases)");
  add_run_options(*run_command, options);
  run_command->add_option("-o,--output", options.output, "Result folder (default: results/<case>)");
  run_command->add_flag("--force", options.force, "Replace an existing result");
  run_command->get_option("case")->required();

  CLI::App* check_command = on(program.add_subcommand("check", "Check a case and print what it means, in SI units"),
                               [&] { return check(options); });
  add_case_options(*check_command, options, "Case file, or the name of a shipped case");
  check_command->get_option("case")->required();

  on(program.add_subcommand("cases", "List the cases that ship with Riven"), [] { return cases(); });

  CLI::App* verify_command = on(program.add_subcommand("verify", "Run shipped cases and hold them against their references"),
                                [&] { return verify(options, brief); });
  add_case_options(*verify_command, options, "Topic or case (default: all)");
  add_run_options(*verify_command, options);
  verify_command->add_flag("--short", brief, "Run the short variants of cases that have one");

  CLI::App* compare_command = on(program.add_subcommand("compare", "Hold a result against reference points or a history"),
                                 [&] { return compare(comparison); });
  compare_command->add_option("dir", comparison.folder, "Result folder")->required();
  compare_command->add_option("reference", comparison.reference, "CSV file: X_m, Y_m, ux_m, uy_m, and lambda, stretch, t_s or time")
      ->required();
  compare_command->add_option("--exclude-within", comparison.exclude_within,
                              "Leave out points nearer than this to an edge of a defect: \"15 mm\", \"1 horizon\"");
  compare_command->add_option("--tolerance", comparison.tolerance, "Exit with 1 when a relative L2 deviation is above: 1%");
  compare_command->add_option("--history", comparison.history, "Compare a column of history.csv instead: metric=column");
  compare_command->add_flag("--json", comparison.json, "Print JSON");

  CLI::App* schema_command = on(program.add_subcommand("schema", "Print the JSON Schema of the case format"),
                                [&] { return schema(markdown); });
  schema_command->add_flag("--markdown", markdown, "Print the reference page instead");

  on(program.add_subcommand("version", "Print the version"), [] {
    fmt::print("riven {}\n", RIVEN_VERSION);
    return static_cast<int>(kDone);
  });

  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? kDone : kWrongInput;
  }
  return code;
}
