#include "output/checkpoint.hpp"

#include <fmt/format.h>
#include <hdf5.h>
#include <zlib.h>

#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.hpp"
#include "base/instruction_set.hpp"
#include "output/atomic_file.hpp"

namespace riven {
namespace {

constexpr int kFormat = 2;
constexpr std::size_t kHeader = 512;  // bytes; what HDF5 calls the user block
constexpr const char* kMagic = "Riven checkpoint\n";
constexpr const char* kUnknownSum = "00000000";
constexpr const char* kCaseValues = "case";

/// An HDF5 identifier, closed at the end.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close how) : id_(id), close_(how) {
    if (id_ < 0) throw RunError("HDF5 refuses");
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }  // what the functions of HDF5 take
  /// Closes now; what could not be written shows here at the latest.
  void close() {
    if (close_(std::exchange(id_, -1)) < 0) throw RunError("HDF5 refuses");
  }

 private:
  hid_t id_;
  Close close_;
};

void check(herr_t status) {
  if (status < 0) throw RunError("HDF5 refuses");
}

template <class T>
struct Number;
template <>
struct Number<double> {
  static hid_t in_memory() { return H5T_NATIVE_DOUBLE; }
  static hid_t in_file() { return H5T_IEEE_F64LE; }
};
template <>
struct Number<std::int64_t> {
  static hid_t in_memory() { return H5T_NATIVE_INT64; }
  static hid_t in_file() { return H5T_STD_I64LE; }
};
template <>
struct Number<std::uint8_t> {
  static hid_t in_memory() { return H5T_NATIVE_UINT8; }
  static hid_t in_file() { return H5T_STD_U8LE; }
};

template <class T>
void write_array(hid_t file, const std::string& name, const std::vector<T>& values) {
  const hsize_t size = values.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  Handle set(
      H5Dcreate2(file, name.c_str(), Number<T>::in_file(), space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Dclose);
  if (size > 0) check(H5Dwrite(set, Number<T>::in_memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  set.close();
}

template <class T>
std::vector<T> read_array(hid_t set) {
  const Handle space(H5Dget_space(set), H5Sclose);
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  if (size < 0) throw RunError("HDF5 refuses");
  std::vector<T> values(static_cast<std::size_t>(size));
  if (size > 0) check(H5Dread(set, Number<T>::in_memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  return values;
}

Snapshot::Array read_any(hid_t set) {
  const Handle type(H5Dget_type(set), H5Tclose);
  if (H5Tget_class(type) == H5T_FLOAT) return read_array<double>(set);
  if (H5Tget_size(type) == 1) return read_array<std::uint8_t>(set);
  return read_array<std::int64_t>(set);
}

void write_arrays(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  const std::string values = nlohmann::json(checkpoint.case_values).dump(-1, ' ', true);
  const Handle plan(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  check(H5Pset_userblock(plan, kHeader));
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, plan, H5P_DEFAULT), H5Fclose);
  write_array(file, kCaseValues, Snapshot::Bytes(values.begin(), values.end()));
  for (const auto& [name, array] : checkpoint.state.arrays)
    std::visit([&, &key = name](const auto& numbers) { write_array(file, key, numbers); }, array);
  file.close();
}

void read_arrays(const std::filesystem::path& path, Checkpoint& checkpoint) {
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const auto visit = [](hid_t group, const char* name, const H5L_info_t*, void* to) -> herr_t {
    static_cast<std::vector<std::string>*>(to)->emplace_back(name);
    return group < 0 ? -1 : 0;
  };
  std::vector<std::string> names;
  check(H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &names));
  for (const std::string& name : names) {
    const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
    checkpoint.state.arrays.emplace(name, read_any(set));
  }
  const auto text = std::get<Snapshot::Bytes>(checkpoint.state.arrays.extract(kCaseValues).mapped());
  checkpoint.case_values = nlohmann::json::parse(text).get<std::map<std::string, std::string>>();
}

std::string header(const std::string& version, const std::string& sum) {
  std::string text = fmt::format("{}format {}\nriven {}\ncrc32 {}\n", kMagic, kFormat, version, sum);
  text.resize(kHeader, '\0');
  return text;
}

/// Checksum (hexadecimal) of `head` and of what follows the header in a file.
std::string checksum(const std::string& head, std::istream& file) {
  uLong sum = crc32(0, nullptr, 0);
  const auto add = [&sum](const char* data, std::size_t size) {
    sum = crc32(sum, reinterpret_cast<const Bytef*>(data), static_cast<uInt>(size));
  };
  add(head.data(), head.size());
  file.seekg(kHeader);
  std::vector<char> buffer(1 << 20);
  do {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    add(buffer.data(), static_cast<std::size_t>(file.gcount()));
  } while (file);
  return fmt::format("{:08x}", sum);
}

/// The rest of a header's line that begins with `key`; empty if there is none.
std::string line_of(const std::string& head, const std::string& key) {
  const std::size_t begin = head.find("\n" + key + " ");
  if (begin == std::string::npos) return "";
  const std::size_t from = begin + key.size() + 2;
  return head.substr(from, head.find('\n', from) - from);
}

/// Checks all that can be told without HDF5. Returns the version of the program that wrote the file.
std::string check_header(const std::filesystem::path& path) {
  const Location at{path.string()};
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(at, "cannot be read; are you allowed to?");
  std::string head(kHeader, '\0');
  file.read(head.data(), static_cast<std::streamsize>(kHeader));
  if (!head.starts_with(kMagic))
    throw InputError(at, "is no checkpoint of Riven, or damaged at its beginning");
  if (!file) throw InputError(at, "is damaged: cut short");
  const std::string format = line_of(head, "format"), version = line_of(head, "riven"),
                    sum = line_of(head, "crc32");
  if (format != std::to_string(kFormat))
    throw InputError(at, fmt::format("has format \"{}\", written by Riven {}; this is Riven {}, which reads "
                                     "format {}",
                                     format, version, RIVEN_VERSION, kFormat));
  if (sum.size() != std::char_traits<char>::length(kUnknownSum))
    throw InputError(at, "is damaged: its header has no checksum");
  head.replace(head.find("\ncrc32 ") + 7, sum.size(), kUnknownSum);
  if (const std::string found = checksum(head, file); found != sum)
    throw InputError(at,
                     fmt::format("is damaged: its contents have the checksum {}, expected {}", found, sum));
  return version;
}

/// HDF5 tells of its troubles on standard error, unless told not to.
void silence() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace

std::string this_program() {
  return fmt::format("{} ({})", RIVEN_VERSION, name(instruction_set()));
}

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) try {
  silence();
  AtomicFile target(path);
  write_arrays(target.temporary(), checkpoint);
  std::ifstream written(target.temporary(), std::ios::binary);
  const std::string sum = checksum(header(checkpoint.version, kUnknownSum), written);
  target.stream() << header(checkpoint.version, sum);
  target.commit_to_disk();
} catch (const RunError&) {
  throw RunError(fmt::format("cannot write {}: is the disk full?", path.string()));
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  silence();
  Checkpoint checkpoint;
  checkpoint.version = check_header(path);
  try {
    read_arrays(path, checkpoint);
  } catch (const std::exception& problem) {
    throw InputError({path.string()}, fmt::format("is no checkpoint of Riven: {}", problem.what()));
  }
  return checkpoint;
}

}  // namespace riven
