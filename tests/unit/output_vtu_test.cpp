#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <stdexcept>

#include "base/error.hpp"
#include "output/atomic_file.hpp"
#include "output/collection.hpp"
#include "output/vtk_array.hpp"
#include "output/vtu.hpp"
#include "scratch.hpp"

namespace riven {
namespace {

using test::message_of;
using test::read_text;
using test::Scratch;
using test::write_text;

PointCloud random_cloud(std::size_t points, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  PointCloud cloud;
  cloud.positions.resize(points);
  for (auto& position : cloud.positions) position = {normal(random), normal(random), normal(random)};
  for (const auto& [name, components] : {std::pair("damage", 1), {"displacement", 3}, {"a<b & \"c\"", 9}}) {
    PointField field{name, components, {}, components == 1 ? "" : "J/m^3 & <m>"};
    field.values.resize(points * static_cast<std::size_t>(components));
    for (double& value : field.values) value = normal(random);
    cloud.fields.push_back(field);
  }
  return cloud;
}

std::vector<std::uint64_t> bits(const std::vector<double>& values) {
  std::vector<std::uint64_t> all;
  for (const double value : values) all.push_back(std::bit_cast<std::uint64_t>(value));
  return all;
}

void expect_same(const PointCloud& a, const PointCloud& b) {
  EXPECT_EQ(a.positions, b.positions);
  ASSERT_EQ(a.fields.size(), b.fields.size());
  for (std::size_t i = 0; i < a.fields.size(); ++i) {
    EXPECT_EQ(a.fields[i].name, b.fields[i].name);
    EXPECT_EQ(a.fields[i].components, b.fields[i].components);
    EXPECT_EQ(a.fields[i].unit, b.fields[i].unit);
    EXPECT_EQ(bits(a.fields[i].values), bits(b.fields[i].values));
  }
}

TEST(Vtu, RoundTripsCloudsOfAnySize) {
  const Scratch scratch;
  // 4096 doubles fill one block: sizes on both sides of it, several blocks, one point, none.
  for (const std::size_t points : {0, 1, 2, 1365, 4095, 4096, 4097, 100000}) {
    SCOPED_TRACE(points);
    const PointCloud cloud = random_cloud(points, static_cast<unsigned>(points));
    write_vtu(scratch / "a.vtu", cloud);
    expect_same(read_vtu(scratch / "a.vtu"), cloud);
  }
}

TEST(Vtu, KeepsNonFiniteValuesAndSignedZero) {
  const Scratch scratch;
  const double inf = std::numeric_limits<double>::infinity();
  const PointCloud cloud{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}},
                         {{"f", 1, {std::numeric_limits<double>::quiet_NaN(), -inf, -0.0, 5e-324}}}};
  write_vtu(scratch / "a.vtu", cloud);
  expect_same(read_vtu(scratch / "a.vtu"), cloud);
}

TEST(Vtu, IsDeclaredAsParaViewExpects) {
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", random_cloud(5, 1));
  const std::string text = read_text(scratch / "a.vtu");
  for (const char* part :
       {"type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"",
        "compressor=\"vtkZLibDataCompressor\"", "<Piece NumberOfPoints=\"5\" NumberOfCells=\"5\">",
        "Name=\"connectivity\"", "Name=\"offsets\"", "type=\"UInt8\" Name=\"types\"",
        "Name=\"displacement\" NumberOfComponents=\"3\""}) {
    EXPECT_NE(text.find(part), text.npos) << part;
  }
}

TEST(Vtu, CompressesWhatRepeats) {
  const Scratch scratch;
  PointCloud cloud = random_cloud(0, 1);
  cloud.positions.assign(50000, {1, 2, 3});
  cloud.fields = {{"damage", 1, std::vector<double>(50000, 0.25)}};
  write_vtu(scratch / "a.vtu", cloud);
  EXPECT_LT(std::filesystem::file_size(scratch / "a.vtu"), 50000u * 32 / 4);
}

PointCloud random_mesh(std::size_t points, unsigned seed) {
  PointCloud mesh = random_cloud(points, seed);
  std::mt19937 random(seed);
  for (const CellKind kind : {CellKind::quad, CellKind::line, CellKind::triangle, CellKind::line}) {
    mesh.cells.push_back({kind, {}});
    const std::size_t nodes = corners(kind) * (1 + random() % 5000);
    for (std::size_t n = 0; n < nodes; ++n)
      mesh.cells.back().nodes.push_back(static_cast<std::uint32_t>(random() % points));
  }
  return mesh;
}

TEST(Vtu, RoundTripsMeshes) {
  const Scratch scratch;
  for (const std::size_t points : {1, 40, 9000}) {
    const PointCloud mesh = random_mesh(points, static_cast<unsigned>(points));
    write_vtu(scratch / "a.vtu", mesh);
    const PointCloud back = read_vtu(scratch / "a.vtu");
    expect_same(back, mesh);
    ASSERT_EQ(back.cells.size(), mesh.cells.size());
    for (std::size_t n = 0; n < mesh.cells.size(); ++n) {
      EXPECT_EQ(back.cells[n].kind, mesh.cells[n].kind);
      EXPECT_EQ(back.cells[n].nodes, mesh.cells[n].nodes);
    }
  }
  write_vtu(scratch / "b.vtu", random_cloud(40, 1));
  EXPECT_TRUE(read_vtu(scratch / "b.vtu").cells.empty()) << "bare points";
}

/// A file whose array of cells of this name holds other bytes.
template <class T>
void replace_array(const std::filesystem::path& file, const std::string& name, const std::vector<T>& values) {
  std::string text = read_text(file);
  const std::size_t begin = text.find('\n', text.find("Name=\"" + name + "\"")) + 1;
  text.replace(begin, text.find('\n', begin) - begin, encode_vtk_array(std::as_bytes(std::span(values))));
  write_text(file, text);
}

TEST(Vtu, RefusesCellsThatItDoesNotKnowOrThatDoNotFit) {
  const Scratch scratch;
  PointCloud mesh = random_cloud(4, 1);
  mesh.cells = {{CellKind::quad, {0, 1, 2, 3}}};
  const auto refused = [&] { return message_of<InputError>([&] { read_vtu(scratch / "a.vtu"); }); };
  write_vtu(scratch / "a.vtu", mesh);
  replace_array<std::uint8_t>(scratch / "a.vtu", "types", {42});
  EXPECT_NE(refused().find("type 42; expected bare vertices (1), or lines (3)"), std::string::npos);
  write_vtu(scratch / "a.vtu", mesh);
  replace_array<std::uint8_t>(scratch / "a.vtu", "types", {5});  // three corners, where there are four
  EXPECT_NE(refused().find("\"connectivity\""), std::string::npos);
  for (const std::int64_t node : {std::int64_t{4}, std::int64_t{-1}}) {
    write_vtu(scratch / "a.vtu", mesh);
    replace_array<std::int64_t>(scratch / "a.vtu", "connectivity", {0, 1, node, 3});
    EXPECT_NE(refused().find("a cell has point " + std::to_string(node) + " of 4"), std::string::npos);
  }
  mesh.cells = {{CellKind::quad, {0, 1, 2, 4}}};
  EXPECT_THROW(write_vtu(scratch / "b.vtu", mesh), std::invalid_argument);
  mesh.cells = {{CellKind::quad, {0, 1, 2}}};
  EXPECT_THROW(write_vtu(scratch / "b.vtu", mesh), std::invalid_argument);
}

TEST(Vtu, RefusesFieldsOfTheWrongSize) {
  const Scratch scratch;
  PointCloud cloud = random_cloud(3, 1);
  cloud.fields[1].values.pop_back();
  EXPECT_THROW(write_vtu(scratch / "a.vtu", cloud), std::invalid_argument);
  EXPECT_EQ(scratch.entries(), 0);
}

TEST(Vtu, RefusesMissingAndForeignFiles) {
  const Scratch scratch;
  EXPECT_NE(message_of<InputError>([&] { read_vtu(scratch / "no.vtu"); }).find("no such file"),
            std::string::npos);
  write_text(scratch / "a.vtu", "<VTKFile type=\"PolyData\"></VTKFile>");
  EXPECT_NE(message_of<InputError>([&] { read_vtu(scratch / "a.vtu"); }).find("PolyData"), std::string::npos);
  write_text(scratch / "b.vtu", "no XML at all");
  EXPECT_NE(message_of<InputError>([&] { read_vtu(scratch / "b.vtu"); }).find("damaged"), std::string::npos);
}

TEST(Vtu, RefusesFilesThatAreCutOffAnywhere) {
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", random_cloud(40, 2));
  const std::string text = read_text(scratch / "a.vtu");
  const std::size_t last_tag = text.rfind("</VTKFile>");
  for (std::size_t length = 0; length < last_tag; length += 37) {
    write_text(scratch / "b.vtu", text.substr(0, length));
    EXPECT_THROW(read_vtu(scratch / "b.vtu"), InputError) << length;
  }
}

TEST(Vtu, DamagedBytesNeverCrashAndDamagedDataIsRefused) {
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", random_cloud(40, 3));
  const std::string text = read_text(scratch / "a.vtu");
  std::mt19937 random(4);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = text;
    damaged[random() % damaged.size()] = static_cast<char>('A' + random() % 26);
    write_text(scratch / "b.vtu", damaged);
    try {
      read_vtu(scratch / "b.vtu");  // a change in a name or in the cells is not seen
    } catch (const InputError&) {
    }
  }
  const std::size_t array = text.find("Name=\"displacement\"");
  const std::size_t data = text.find('\n', array) + 1 + 60;  // behind the header's 44 characters
  std::string damaged = text;
  damaged[data] = damaged[data] == 'A' ? 'B' : 'A';
  write_text(scratch / "b.vtu", damaged);
  const std::string message = message_of<InputError>([&] { read_vtu(scratch / "b.vtu"); });
  EXPECT_NE(message.find("b.vtu"), message.npos);
  EXPECT_NE(message.find("\"displacement\""), message.npos);
}

TEST(Vtu, RefusesANumberOfPointsThatTheDataDoesNotHave) {
  const Scratch scratch;
  write_vtu(scratch / "a.vtu", random_cloud(40, 3));
  for (const char* number : {"39", "41", "0", "2305843009213693952", "1099511627776"}) {
    std::string text = read_text(scratch / "a.vtu");
    text.replace(text.find("\"40\""), 4, '"' + std::string(number) + '"');
    write_text(scratch / "b.vtu", text);
    EXPECT_THROW(read_vtu(scratch / "b.vtu"), InputError) << number;
  }
}

TEST(Vtu, RefusesPointsAtNoPlace) {
  const Scratch scratch;
  for (const double nowhere :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    PointCloud cloud = random_cloud(4, 1);
    cloud.positions[2][1] = nowhere;
    write_vtu(scratch / "a.vtu", cloud);
    EXPECT_NE(message_of<InputError>([&] { read_vtu(scratch / "a.vtu"); }).find("finite"), std::string::npos);
  }
}

TEST(VtkArray, HeaderStatesBlocksAsVtkReadsThem) {
  // 3 zero bytes: one block of 32768, the last one of 3 bytes. Base64 of the 64-bit words 1, 32768, 3 is
  // known.
  const std::vector<std::byte> bytes(3);
  EXPECT_EQ(encode_vtk_array(bytes).substr(0, 32), "AQAAAAAAAAAAgAAAAAAAAAMAAAAAAAAA");
  // A whole block is no partial one.
  const std::vector<std::byte> block(32768);
  EXPECT_EQ(encode_vtk_array(block).substr(0, 32), "AQAAAAAAAAAAgAAAAAAAAAAAAAAAAAAA");
}

TEST(AtomicFile, TakesItsNameOnlyWhenCommitted) {
  const Scratch scratch;
  write_text(scratch / "a", "old");
  {
    AtomicFile file(scratch / "a");
    file.stream() << "half of the n" << std::flush;
    EXPECT_EQ(read_text(scratch / "a"), "old");
    EXPECT_EQ(scratch.entries(), 2);
  }
  EXPECT_EQ(read_text(scratch / "a"), "old");
  EXPECT_EQ(scratch.entries(), 1);
  AtomicFile file(scratch / "a");
  file.stream() << "new";
  file.commit();
  EXPECT_EQ(read_text(scratch / "a"), "new");
  EXPECT_EQ(scratch.entries(), 1);
}

TEST(AtomicFile, SaysWhatCannotBeWritten) {
  const Scratch scratch;
  EXPECT_NE(message_of<RunError>([&] { AtomicFile(scratch / "no/a"); }).find("no/a"), std::string::npos);
}

TEST(AtomicFile, AFullDiskKeepsTheOldFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
  const Scratch scratch;
  write_text(scratch / "a", "old");
  AtomicFile file(scratch / "a");
  file.stream().close();
  file.stream().open("/dev/full", std::ios::binary);
  file.stream() << "new";
  EXPECT_THROW(file.commit(), RunError);
  EXPECT_EQ(read_text(scratch / "a"), "old");
}

TEST(Collection, IsReadableAfterEachState) {
  const Scratch scratch;
  Collection collection(scratch / "fields.pvd");
  const std::vector<double> values{1, 1.1, 1.0 / 3, 4.3e-5};
  for (std::size_t i = 0; i < values.size(); ++i) {
    collection.add(values[i], "fields/000" + std::to_string(i) + ".vtu");
    const auto entries = read_collection(scratch / "fields.pvd");
    ASSERT_EQ(entries.size(), i + 1);
    EXPECT_EQ(entries[i].value, values[i]);
    EXPECT_EQ(entries[i].file, scratch / ("fields/000" + std::to_string(i) + ".vtu"));
    EXPECT_EQ(scratch.entries(), 1);
  }
}

TEST(Collection, RefusesDamagedFiles) {
  const Scratch scratch;
  const auto refused = [&](const std::string& text) {
    write_text(scratch / "a.pvd", text);
    return message_of<InputError>([&] { read_collection(scratch / "a.pvd"); });
  };
  EXPECT_NE(refused("<VTKFile><Collec").find("damaged"), std::string::npos);
  EXPECT_NE(refused("<VTKFile/>").find("Collection"), std::string::npos);
  EXPECT_NE(refused("<VTKFile><Collection><DataSet timestep=\"1\" file=\"a\"/><DataSet timestep=\"1x\" "
                    "file=\"a\"/></Collection></VTKFile>")
                .find("state 2"),
            std::string::npos);
  EXPECT_NE(refused("<VTKFile><Collection><DataSet timestep=\"1\"/></Collection></VTKFile>").find("state 1"),
            std::string::npos);
  EXPECT_THROW(read_collection(scratch / "no.pvd"), InputError);
}

}  // namespace
}  // namespace riven
