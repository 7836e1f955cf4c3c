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

/// The commands with their options; parsing runs the one that was asked for.
class CommandLine {
 public:
  CommandLine() {
    program_.require_subcommand(1);
    program_.set_version_flag("--version", "riven " RIVEN_VERSION);
    add_new();
    add_run();
    add_check();
    add("cases", "List the cases that ship with Riven", [] { return cases(); });
    add_verify();
    add_compare();
    add_report();
    add_plot();
    add_material();
    add_sweep();
    add_schema();
    add("version", "Print the version", [] {
      fmt::print("riven {}\n", RIVEN_VERSION);
      return static_cast<int>(kDone);
    });
    add("help", "Explain a command", [this] {
      return help(program_, overview_, topic_);
    }).add_option("command", topic_, "The command");
    overview_ = program_.help();  // once a command is chosen, this gives the command's own
  }

  int run(int argc, char** argv) {
    if (argc < 2) {
      fmt::print(stderr, "{}", overview_);
      return kWrongInput;
    }
    if (const auto wrong = wrong_command(program_, argv[1])) return refuse(*wrong);
    try {
      program_.parse(argc, argv);
    } catch (const CLI::Success& asked) {
      return delivered(program_.exit(asked));
    } catch (const CLI::ParseError& error) {
      return refuse(wrong_arguments(program_, error));
    }
    return delivered(code_);
  }

 private:
  static int refuse(const std::string& what) {
    fmt::print(stderr, "error: {}\n", what);
    return kWrongInput;
  }

  CLI::App& add(const char* name, const char* doc, std::function<int()> action) {
    CLI::App& command = *program_.add_subcommand(name, doc);
    command.callback([this, action = std::move(action)] { code_ = guarded(action); });
    return command;
  }

  /// Options that every command that reads a case has.
  CLI::Option& add_case(CLI::App& command, const char* target) {
    command
        .add_option("--set", options_.set, "Override a key of the case: path.to.key=value (may be repeated)")
        ->type_size(1)
        ->allow_extra_args(false);
    command.add_option("--threads", options_.threads, "Number of threads (default: all cores)")
        ->check(CLI::Range(1, 1024));
    return *command.add_option("case", options_.target, target);
  }

  void add_new() {
    CLI::App& command = add("new", "Write a commented case to start from: riven new CASE.toml",
                            [this] { return new_case(new_); });
    command.add_option("file", new_.file, "File to write (default: KIND.toml)");
    command.add_option("--kind", new_.kind, "Which case (default: membrane)");
    command.add_flag("--list", new_.list, "List the kinds");
    command.add_flag("--force", new_.force, "Replace files that exist");
  }

  void add_run() {
    CLI::App& command = add("run", "Run a case: riven run CASE.toml", [this] { return app::run(options_); });
    add_case(command, "Case file, or the name of a shipped case (riven cases)").required();
    command.add_option("-o,--output", options_.output, "Result folder (default: results/<case>)");
    CLI::Option* force = command.add_flag("--force", options_.force, "Replace an existing result");
    command.add_flag("--resume", options_.resume, "Go on with a run that stopped, from its last checkpoint")
        ->excludes(force);
    command.add_option("--checkpoint-every", options_.checkpoint_every,
                       "Time or steps between checkpoints: \"5 min\", \"1000 steps\" or \"never\"");
    command.add_flag("--report", options_.report, "Write report.html into the result folder at the end");
  }

  void add_check() {
    CLI::App& command =
        add("check", "Check a case and print what it means, in SI units", [this] { return check(options_); });
    add_case(command, "Case file, or the name of a shipped case").required();
  }

  void add_verify() {
    CLI::App& command = add("verify", "Run shipped cases and hold them against their references",
                            [this] { return verify(options_, verification_); });
    add_case(command, "Topic or case (default: all)");
    command.add_flag("--force", options_.force, "Replace results of riven run too");
    command.add_flag("--short", verification_.brief, "Run the short variants of cases that have one");
    command.add_flag("--report", verification_.gallery,
                     "Write results/gallery.html, a page that shows all cases");
  }

  void add_compare() {
    CompareOptions& to = comparison_;
    CLI::App& command =
        add("compare", "Hold a result against reference points or a history", [&to] { return compare(to); });
    command.add_option("dir", to.folder, "Result folder")->required();
    command
        .add_option("reference", to.reference,
                    "CSV file: X_m, Y_m, ux_m, uy_m, and lambda, stretch, t_s or time")
        ->required();
    command.add_option("--exclude-within", to.exclude_within,
                       "Leave out points nearer than this to an edge of a defect: \"15 mm\", \"1 horizon\"");
    command.add_option("--tolerance", to.tolerance, "Exit with 1 when a relative L2 deviation is above: 1%");
    command.add_option("--history", to.history, "Compare a column of history.csv instead: metric=column");
    command.add_flag("--json", to.json, "Print JSON");
  }

  void add_report() {
    CLI::App& command = add("report", "Show results in one HTML page: riven report DIR...",
                            [this] { return report(report_); });
    command.add_option("dir", report_.folders, "Result folders")->required();
    command.add_option("-o,--output", report_.output,
                       "File to write (default: report.html, in the folder if there is one)");
    command.add_flag("--force", report_.force, "Replace a file that is no report");
  }

  void add_plot() {
    PlotOptions& to = plot_;
    CLI::App& command = add("plot", "Draw a result: riven plot DIR", [&to] { return plot(to); });
    command.add_option("dir", to.folder, "Result folder")->required();
    command.add_option("-o,--output", to.output,
                       "Picture: .png, .svg or .pdf (default: in the result folder)");
    command.add_option("--size", to.size, "Pixels (default: 1600x1200 at most)");
    CLI::Option* history =
        command.add_option("--history", to.history, "Chart of columns of history.csv: COLUMN[,COLUMN...]");
    const auto add_to_field = [&](const char* name, auto& value, const char* doc) {
      return command.add_option(name, value, doc)->excludes(history);
    };
    add_to_field("--field", to.field, "damage, displacement_x, ... (default: what tells most)");
    add_to_field("--state", to.state, "Number from 0, or from -1 at the end; first, last (default), all");
    add_to_field("--scale", to.scale, "Of the displacements (default: 1)");
    add_to_field("--range", to.range, "Values of the first and the last colour: a,b");
    add_to_field("--map", to.map, "Colours (default: by the values)");
  }

  void add_material() {
    MaterialOptions& to = material_;
    CLI::App& command = add("material", "Curves of the materials of a case: riven material CASE",
                            [&to] { return material(to); });
    command.add_option("case", to.target, "Case file, or the name of a shipped case")->required();
    command.add_option("--set", to.set, "Override a key of the case: path.to.key=value (may be repeated)")
        ->type_size(1)
        ->allow_extra_args(false);
    command.add_option("--material", to.material, "Only this one");
    command.add_option("--range", to.range,
                       "Stretches from a to b: a,b (default: 0.7,3 of rubbers; 0.9,1.1 of laws with a "
                       "Poisson's ratio)");
    command.add_option("--points", to.points, "Points of each curve (default: 101)")
        ->check(CLI::Range(2, 1000000));
    command.add_option("--size", to.size, "Pixels of the pictures (default: 1600x1200)");
    command.add_option("-o,--output", to.output, "Folder of the curves (default: results/<case>-material)");
    command.add_flag("--force", to.force, "Replace files that exist");
  }

  void add_sweep() {
    SweepOptions& to = sweep_;
    CLI::App& command =
        add("sweep", "Run a case with several values of some keys: riven sweep CASE [KEY=a,b]",
            [&to] { return sweep(to); });
    command.add_option("case", to.target, "Case file, or the name of a shipped case")->required();
    command.add_option(
        "keys", to.keys,
        "KEY=a,b,c: as for --set, all combinations are run; KEY1,KEY2=(a,b),(c,d) of keys that change "
        "together (default: the case's [study])");
    command
        .add_option("--plot", to.plots,
                    "What the chart shows: X,Y, columns of the histories, or KEY,METRIC (may be repeated)")
        ->type_size(1)
        ->allow_extra_args(false);
    command
        .add_option("--set", to.set, "Override a key of all variants: path.to.key=value (may be repeated)")
        ->type_size(1)
        ->allow_extra_args(false);
    command.add_option("-o,--output", to.output, "Folder of the results (default: results/<case>-sweep)");
    CLI::Option* force = command.add_flag("--force", to.force, "Replace an existing sweep");
    command.add_flag("--resume", to.resume, "Go on with a sweep that stopped")->excludes(force);
    command.add_option("-j,--jobs", to.jobs, "Runs side by side (default: as many as there are cores)")
        ->check(CLI::Range(1, 1024));
    command
        .add_option("--threads", to.threads, "Threads of each run (default: the cores divided among them)")
        ->check(CLI::Range(1, 1024));
    command.add_flag("--report", to.report, "Write report.html with all variants at the end");
  }

  void add_schema() {
    CLI::App& command =
        add("schema", "Print the JSON Schema of the case format", [this] { return schema(markdown_); });
    command.add_flag("--markdown", markdown_, "Print the reference page instead");
  }

  CLI::App program_{"Riven: how rubber, glass and shells deform and break, by peridynamics", "riven"};
  std::string overview_;
  Options options_;
  NewOptions new_;
  ReportOptions report_;
  CompareOptions comparison_;
  PlotOptions plot_;
  MaterialOptions material_;
  SweepOptions sweep_;
  VerifyOptions verification_;
  bool markdown_ = false;
  std::string topic_;  // of help
  int code_ = kDone;
};

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files shows as a full disk does, with a message
  return CommandLine().run(argc, argv);
}
