#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace riven::app {

/// What the user asked for on the command line, one member per option that commands share.
struct Options {
  std::string target;            // case file, topic or result folder
  std::vector<std::string> set;  // --set path=value
  std::filesystem::path output;  // -o; empty: the default
  bool force = false;
  bool resume = false;
  std::string checkpoint_every;  // empty: as the case says
  int threads = 0;               // 0: all cores
  bool report = false;
};

struct ReportOptions {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path output;  // empty: report.html, in the folder where there is one
  bool force = false;
};

struct CompareOptions {
  std::filesystem::path folder;
  std::filesystem::path reference;
  std::string exclude_within;  // a length, or "1 horizon"
  std::string tolerance;       // "1 %"; empty: report only
  std::string history;         // metric=column; empty: the displacement field
  bool json = false;
};

struct NewOptions {
  std::filesystem::path file;  // empty: named after the kind
  std::string kind = "membrane";
  bool list = false;
  bool force = false;
};

struct PlotOptions {
  std::filesystem::path folder;
  std::filesystem::path output;  // empty: in the folder
  std::string field;             // empty: the one that tells most
  std::string state = "last";    // or "first", "all", a number
  std::string history;           // columns: a chart of them instead of a field
  double scale = 1;              // of displacements
  std::string range;             // "0, 2 MPa"; empty: from the values
  std::string map;               // of colours; empty: by the values
  std::string size;              // "1600x1200"; empty: that, without empty margins
};

struct MaterialOptions {
  std::string target;            // case file or the name of a shipped case
  std::vector<std::string> set;  // --set path=value
  std::filesystem::path output;  // -o; empty: the default
  std::string material;          // empty: all of the case
  std::string range;             // of stretches, "0.5, 3"; empty: by the law
  int points = 101;
  std::string size;  // of pictures, "1600x1200"; empty: that
  bool force = false;
};

struct VerifyOptions {
  bool brief = false;    // run the [short] variants
  bool gallery = false;  // write a page that shows all cases
};

struct SweepOptions {
  std::string target;              // case file or the name of a shipped case
  std::vector<std::string> keys;   // KEY=a,b,c; none: those of the case's study
  std::vector<std::string> plots;  // "x, y"; none: those of the study, or a choice
  std::vector<std::string> set;    // --set path=value, of all variants
  std::filesystem::path output;    // -o; empty: the default
  bool force = false;
  bool resume = false;
  int jobs = 0;     // runs side by side; 0: as many as there are cores
  int threads = 0;  // of each run; 0: the cores divided among them
  bool report = false;
};

enum ExitCode : int { kDone = 0, kMissed = 1, kWrongInput = 2, kFailed = 3, kInterrupted = 130 };

/// Runs a command; an exception becomes one message on standard error and the exit code that belongs to it.
int guarded(const std::function<int()>& command);

/// Writes a commented case to start from, and the files that it reads.
int new_case(const NewOptions& options);
int run(const Options& options);
int check(const Options& options);
int cases();
int verify(const Options& options, const VerifyOptions& how);
int compare(const CompareOptions& options);
int schema(bool markdown);
/// Writes the page of results.
int report(const ReportOptions& options);
/// The page of results that another command has made, in `folder`. What is wrong with it is told; returns the
/// exit code.
int report_after(const std::vector<std::filesystem::path>& results, const std::filesystem::path& folder);
/// Draws fields or histories of a result.
int plot(const PlotOptions& options);
/// Writes and draws the curves of the materials of a case.
int material(const MaterialOptions& options);
/// Runs a case with all combinations of some values.
int sweep(const SweepOptions& options);

/// Folder of the shipped cases.
std::filesystem::path cases_folder();
/// Whether a file is one of them.
bool is_shipped(const std::filesystem::path& file);
/// A case by its file, or a shipped one by topic/name. Throws InputError with what is near.
std::filesystem::path find_case(const std::string& target);
/// results/<topic>/<name> for shipped cases, results/<file stem> otherwise.
std::filesystem::path default_output(const std::filesystem::path& case_file);
/// "topic/name" or the file's stem: the name of the case in summaries.
std::string case_name(const std::filesystem::path& case_file);

/// A word as the shell reads it.
std::string shell_word(const std::string& word);
/// The parts between commas that stand outside of brackets and quotes, without blanks around them.
std::vector<std::string> split_at_commas(const std::string& text);
/// A text as the name of a file: what is neither letter, digit nor one of ._-+=, becomes _.
std::string file_word(const std::string& text);

}  // namespace riven::app
