#include "report/packed.hpp"

#include <zlib.h>

#include <cstddef>
#include <stdexcept>
#include <vector>

#include "base/base64.hpp"

namespace riven {

namespace {

/// Byte b of value i becomes byte i of plane b.
std::vector<std::byte> shuffled(std::span<const std::byte> bytes, std::size_t width) {
  const std::size_t count = bytes.size() / width;
  std::vector<std::byte> planes(bytes.size());
  for (std::size_t b = 0; b < width; ++b)
    for (std::size_t i = 0; i < count; ++i) planes[b * count + i] = bytes[i * width + b];
  return planes;
}

std::vector<std::byte> compressed(const std::vector<std::byte>& bytes) {
  uLongf length = compressBound(bytes.size());
  std::vector<std::byte> packed(length);
  const auto* source = reinterpret_cast<const Bytef*>(bytes.data());
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &length, source, bytes.size(),
                Z_DEFAULT_COMPRESSION) != Z_OK)
    throw std::runtime_error("zlib cannot compress the numbers of a page");
  packed.resize(length);
  return packed;
}

template <class T>
nlohmann::json pack(const char* type, std::span<const T> values) {
  std::string data;
  append_base64(data, compressed(shuffled(std::as_bytes(values), sizeof(T))));
  return {{"type", type}, {"count", values.size()}, {"data", std::move(data)}};
}

}  // namespace

nlohmann::json packed(std::span<const float> values) {
  return pack("float32", values);
}

nlohmann::json packed(std::span<const double> values) {
  return pack("float64", values);
}

nlohmann::json packed(std::span<const std::uint32_t> values) {
  return pack("uint32", values);
}

std::string json_text(const nlohmann::json& json) {
  std::string text = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  const std::string escaped = "\\u003c";
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + escaped.size()))
    text.replace(at, 1, escaped);
  return text;
}

}  // namespace riven
