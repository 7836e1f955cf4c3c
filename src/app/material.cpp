#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/commands.hpp"
#include "base/csv.hpp"
#include "base/error.hpp"
#include "base/nearest_name.hpp"
#include "input/case_reader.hpp"
#include "input/formula.hpp"
#include "input/material_format.hpp"
#include "material/stability.hpp"
#include "output/atomic_file.hpp"
#include "report/chart.hpp"
#include "simulation/materials.hpp"

namespace riven::app {

namespace fs = std::filesystem;

namespace {

struct StretchRange {
  double low = 0, high = 0;
};

double range_end(const std::string& text) {
  return parse_quantity(text, dimension::none, Symbols{}, Origin{"--range", {}});
}

/// Laws of a Young's modulus and a Poisson's ratio are for less than rubbers go through.
StretchRange range_of(const MaterialOptions& options, const Material& material) {
  if (options.range.empty())
    return std::visit([]<class L>(const L&) { return OfGradient<L>; }, material.law) ? StretchRange{0.9, 1.1}
                                                                                     : StretchRange{0.7, 3};
  const std::vector<std::string> ends = split_at_commas(options.range);
  if (ends.size() != 2)
    throw InputError(fmt::format("--range {}: expected two stretches, as in 0.5,3", options.range));
  const StretchRange range{range_end(ends[0]), range_end(ends[1])};
  if (!(range.low > 0 && range.low < range.high && std::isfinite(range.high)))
    throw InputError(fmt::format("--range {}: expected the lower stretch first, and above 0", options.range));
  return range;
}

/// The materials that are asked for.
std::vector<MaterialInput> chosen(const Case& input, const std::string& name) {
  std::vector<MaterialInput> some;
  std::vector<std::string> names;
  for (const MaterialInput& in : input.materials) {
    names.push_back(in.name);
    if (name.empty() || in.name == name) some.push_back(in);
  }
  if (some.empty())
    throw InputError(fmt::format("--material {}: the case has no such material; it has {}{}", name,
                                 listed(names), did_you_mean(name, names)));
  for (const MaterialInput& in : some)
    if (!is_complete(in))
      throw InputError(in.at, fmt::format("material.{}.poissons_ratio: missing; curves need a number above "
                                          "-1 and below 0.5",
                                          in.name));
  return some;
}

/// Curves over the same places: a table and a picture.
struct Plot {
  std::string suffix;  // of the files
  ChartAxis across;
  std::vector<Curve> curves;
};

std::vector<double> places(double low, double high, int count) {
  std::vector<double> at;
  for (int n = 0; n < count; ++n) at.push_back(low + (high - low) * n / (count - 1));
  at.back() = high;
  return at;
}

std::vector<Plot> plots_of(const Material& material, const StretchRange& range, int points) {
  const auto over = [&](std::initializer_list<Deformation> deformations, const std::vector<double>& at) {
    std::vector<Curve> curves;
    for (const Deformation deformation : deformations) curves.push_back(curve(material, deformation, at));
    return curves;
  };
  // Simple shear by the amount l - 1 / l has the principal stretches l and 1 / l.
  const double shear = std::max(range.high - 1 / range.high, 1 / range.low - range.low);
  std::vector<Plot> plots = {
      {"",
       {"stretch", ""},
       over({Deformation::uniaxial, Deformation::planar, Deformation::equibiaxial},
            places(range.low, range.high, points))},
      {"-shear", {"amount_of_shear", ""}, over({Deformation::simple_shear}, places(0, shear, points))}};
  if (!material.incompressible())
    plots.push_back(
        {"-volume", {"volume_ratio", ""}, over({Deformation::volumetric}, places(0.8, 1.2, points))});
  return plots;
}

fs::path file_of(const fs::path& folder, const std::string& material, const Plot& plot, const char* ending) {
  return folder / (file_word(material) + plot.suffix + ending);
}

std::string column(const Curve& curve) {
  return curve.deformation == Deformation::volumetric ? "pressure" : std::string(name(curve.deformation));
}

void write_table(const fs::path& path, const Plot& plot) {
  AtomicFile file(path);
  file.stream() << plot.across.name;
  for (const Curve& curve : plot.curves) file.stream() << ',' << csv_cell(column(curve) + " [Pa]");
  file.stream() << '\n';
  for (std::size_t n = 0; n < plot.curves.front().at.size(); ++n) {
    std::string row = fmt::format("{}", plot.curves.front().at[n]);
    for (const Curve& curve : plot.curves) fmt::format_to(std::back_inserter(row), ",{}", curve.stress[n]);
    file.stream() << row << '\n';
  }
  file.commit();
}

void draw(const fs::path& path, const std::string& title, const Plot& plot, PictureSize size) {
  Chart chart{.title = title, .x = plot.across};
  chart.y = {plot.curves.size() > 1 ? "nominal_stress" : column(plot.curves.front()), "Pa"};
  for (const Curve& curve : plot.curves) chart.series.push_back({column(curve), curve.at, curve.stress});
  write_picture(path, draw_chart(chart, size, path));
}

/// What is written for one material.
struct Sheet {
  Material material;
  std::string law;
  StretchRange range;
  std::vector<Plot> plots;
};

/// Either all files are written or none.
void check_free(const fs::path& folder, const std::vector<Sheet>& sheets, bool force) {
  if (fs::exists(folder) && !fs::is_directory(folder))
    throw InputError(fmt::format("{}: is a file, expected a folder", folder.string()));
  for (const Sheet& sheet : sheets)
    for (const Plot& plot : sheet.plots)
      for (const char* ending : {".csv", ".png"}) {
        const fs::path path = file_of(folder, sheet.material.name, plot, ending);
        if (fs::exists(path) && (!force || !fs::is_regular_file(path)))
          throw InputError(fmt::format(
              "{}: exists already; expected another folder (-o), or --force to replace it", path.string()));
      }
}

void write(const fs::path& folder, const Sheet& sheet, PictureSize size) {
  const std::string& name = sheet.material.name;
  fmt::print("{}: {}, {}\n", name, sheet.law, moduli_text(sheet.material));
  for (const Instability& instability : instabilities(sheet.material, sheet.range.low, sheet.range.high))
    fmt::print("  warning: {}\n", instability_text(instability));
  for (const Plot& plot : sheet.plots) {
    const fs::path table = file_of(folder, name, plot, ".csv"), picture = file_of(folder, name, plot, ".png");
    write_table(table, plot);
    draw(picture, fmt::format("{}: {}", name, sheet.law), plot, size);
    fmt::print("{}\n{}\n", table.string(), picture.string());
    for (const Curve& curve : plot.curves)
      for (const double end : curve.ends)
        fmt::print("  {} ends at a {} of {:.5g}: the law has no answer beyond\n", column(curve),
                   plot.across.name, end);
  }
}

}  // namespace

int material(const MaterialOptions& options) {
  const PictureSize size = options.size.empty() ? PictureSize{} : picture_size(options.size);
  const Case input = read_case(find_case(options.target), options.set);
  std::vector<Sheet> sheets;
  for (const MaterialInput& in : chosen(input, options.material)) {
    const Material material = make_material(in);
    const StretchRange range = range_of(options, material);
    sheets.push_back({material, in.law, range, plots_of(material, range, options.points)});
  }
  const fs::path folder =
      options.output.empty() ? fs::path(default_output(input.file).string() + "-material") : options.output;
  check_free(folder, sheets, options.force);
  fs::create_directories(folder);
  for (const Sheet& sheet : sheets) write(folder, sheet, size);
  return kDone;
}

}  // namespace riven::app
