#include "app/gallery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>

#include "app/commands.hpp"
#include "base/base64.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "output/atomic_file.hpp"
#include "report/page.hpp"
#include "report/picture.hpp"
#include "report/result.hpp"
#include "report/what_to_show.hpp"

namespace riven::app {

namespace fs = std::filesystem;

namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --text: #1e1e1e; --faint: #5f6368; --line: #d5d8dc; --back: #ffffff;
        --card: #f7f8f9; --good: #0b6b3a; --bad: #b3261e; --link: #0b57a4; }
@media (prefers-color-scheme: dark) {
  :root { --text: #e4e6e8; --faint: #a0a6ad; --line: #3c4147; --back: #17191c; --card: #1f2226; --good: #6fd39b;
          --bad: #ff8a80; --link: #8ab8f0; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1180px; padding: 1rem; background: var(--back); color: var(--text);
       font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.5rem; margin: .2rem 0; }
h2 { font-size: 1.2rem; margin: 2rem 0 .6rem; border-bottom: 1px solid var(--line); }
h3 { font-size: 1rem; margin: 0; }
a { color: var(--link); }
p { margin: .3rem 0; }
.faint { color: var(--faint); font-size: .87rem; }
.conclusion { font-size: 1.05rem; font-weight: 600; }
nav ul { list-style: none; margin: .5rem 0; padding: 0; }
nav li li { display: inline-block; margin: 0 .9rem .2rem 0; white-space: nowrap; }
article { display: grid; grid-template-columns: minmax(0, 360px) minmax(0, 1fr); gap: 1rem; margin: 0 0 1rem;
          padding: .9rem; border: 1px solid var(--line); border-radius: 6px; background: var(--card); }
article header { grid-column: 1 / -1; display: flex; flex-wrap: wrap; gap: .1rem .8rem; align-items: baseline; }
article img { width: 100%; height: auto; display: block; border-radius: 4px; background: #fff; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: .87rem; font-variant-numeric: tabular-nums; }
th, td { padding: .18rem .55rem; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line); }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
th:last-child, td:last-child { text-align: left; }
.good { color: var(--good); font-weight: 600; }
.bad { color: var(--bad); font-weight: 600; }
@media (max-width: 760px) { article { grid-template-columns: minmax(0, 1fr); } }
@media print { body { max-width: none; font-size: 11px; } article { break-inside: avoid; } nav { display: none; }
               .scroll { overflow: visible; } }
)";

/// A path in an address.
std::string address(const fs::path& path) {
  std::string text;
  for (const char c : path.generic_string()) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    text += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return text;
}

std::string topic_of(const Verification& verification) {
  const std::size_t slash = verification.name.find('/');
  return slash == std::string::npos ? "own cases" : verification.name.substr(0, slash);
}

/// The last state, small enough for a page with many of them.
std::string picture(const Result& result) {
  constexpr std::size_t kLargest = 150'000;  // bytes
  const PointCloud last = read_vtu(result.states.back().file);
  const std::string field = telling_field(last, read_vtu(result.states.front().file));
  std::string png;
  for (const PictureSize size : {PictureSize{800, 600}, PictureSize{640, 480}, PictureSize{400, 300}}) {
    png = draw_field(last, scalar_of(last, field),
                     {.size = size, .text = 1.5, .title = state_text(result, result.states.size() - 1)},
                     "picture.png");
    if (png.size() <= kLargest) break;
  }
  std::string text = "data:image/png;base64,";
  append_base64(text, std::as_bytes(std::span(png)));
  return fmt::format("<img alt=\"{}\" src=\"{}\">", escaped(fmt::format("{}, {}", result.title, field)),
                     text);
}

std::string picture_of(const Verification& verification) {
  if (!verification.summary) return "<p class=\"faint\">no picture</p>";
  try {
    const Result result = Result::open(verification.folder);
    if (!result.states.empty()) return picture(result);
  } catch (const InputError&) {
    // A case may write no fields.
  }
  return "<p class=\"faint\">no picture</p>";
}

std::string status_of(const Verification& verification) {
  if (verification.code != kDone)
    return fmt::format("<span class=\"bad\">{}</span>", verification.code == kMissed ? "missed" : "failed");
  const bool decided = std::any_of(verification.verdicts.begin(), verification.verdicts.end(),
                                   [](const Verdict& verdict) { return verdict.decides; });
  return decided ? "<span class=\"good\">ok</span>" : "<span class=\"faint\">no reference</span>";
}

std::string table_of(const Verification& verification) {
  if (!verification.problem.empty())
    return fmt::format("<p class=\"bad\">{}</p>", escaped(verification.problem));
  if (verification.verdicts.empty()) return "<p class=\"faint\">no expectations</p>";
  std::vector<VerdictCells> rows;
  for (const Verdict& verdict : verification.verdicts) rows.push_back(cells(verdict));
  std::vector<std::size_t> used;  // columns; others would only take room
  for (std::size_t c = 0; c < kVerdictColumns.size(); ++c)
    if (std::any_of(rows.begin(), rows.end(), [&](const VerdictCells& row) { return !row[c].empty(); }))
      used.push_back(c);
  std::string text = "<div class=\"scroll\"><table><thead><tr>";
  for (const std::size_t c : used) text += fmt::format("<th>{}</th>", kVerdictColumns[c]);
  text += "</tr></thead><tbody>";
  for (const VerdictCells& row : rows) {
    text += "<tr>";
    for (const std::size_t c : used) {
      const char* kind = row[c] == "ok" ? " class=\"good\"" : row[c] == "MISSED" ? " class=\"bad\"" : "";
      text += fmt::format("<td{}>{}</td>", kind, escaped(row[c]));
    }
    text += "</tr>";
  }
  text += "</tbody></table></div>";
  if (verification.unreached > 0)
    text += fmt::format("<p class=\"faint\">not compared: {} at states that this run does not reach</p>",
                        verification.unreached);
  return text;
}

/// Status, size and time of the run, and where its results are.
std::string facts_of(const Verification& verification, const fs::path& from) {
  if (!verification.summary) return "";
  const Summary& summary = *verification.summary;
  const std::string folder = address(verification.folder.lexically_relative(from));
  std::string text =
      fmt::format("<p class=\"faint\">{}, {} points, {}; <a href=\"{}/\">results</a>", name(summary.status),
                  summary.timing.points, duration_text(summary.timing.wall_s), folder);
  if (fs::exists(verification.folder / kReportFile))
    text += fmt::format(", <a href=\"{}/{}\">report</a>", folder, kReportFile);
  return text + "</p>";
}

std::string article(const Verification& verification, const fs::path& from) {
  return fmt::format(
      "<article id=\"{0}\"><header><h3>{1}</h3><span class=\"faint\">{0}{2}</span>{3}</header>\n"
      "<div>{4}</div><div>{5}{6}</div></article>\n",
      escaped(verification.name),
      escaped(verification.title.empty() ? verification.name : verification.title),
      verification.brief ? " (short)" : "", status_of(verification), picture_of(verification),
      table_of(verification), facts_of(verification, from));
}

std::string contents(const std::map<std::string, std::vector<const Verification*>>& topics) {
  std::string text = "<nav><ul>";
  for (const auto& [topic, cases] : topics) {
    text += fmt::format("<li><a href=\"#topic-{0}\">{0}</a><ul>", escaped(topic));
    for (const Verification* each : cases)
      text += fmt::format("<li><a href=\"#{}\">{}</a> {}</li>", escaped(each->name),
                          escaped(each->name.substr(each->name.find('/') + 1)), status_of(*each));
    text += "</ul></li>";
  }
  return text + "</ul></nav>\n";
}

}  // namespace

void write_gallery(const fs::path& file, const std::vector<Verification>& all,
                   const std::string& conclusion) {
  std::map<std::string, std::vector<const Verification*>> topics;
  for (const Verification& each : all) topics[topic_of(each)].push_back(&each);
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>Riven: verified cases</title>\n<style>{}</style></head><body>\n<h1>Riven: verified cases</h1>\n"
      "<p class=\"conclusion\">{}</p>\n<p class=\"faint\">Riven {}. References decide, published values are "
      "reported.</p>\n",
      kStyle, escaped(conclusion), RIVEN_VERSION);
  page += contents(topics);
  for (const auto& [topic, cases] : topics) {
    page += fmt::format("<section><h2 id=\"topic-{0}\">{0}</h2>\n", escaped(topic));
    for (const Verification* each : cases) page += article(*each, file.parent_path());
    page += "</section>\n";
  }
  AtomicFile target(file);
  target.stream() << page << "</body></html>\n";
  target.commit();
}

}  // namespace riven::app
