#include "output/vtk_array.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "base/base64.hpp"

namespace riven {
namespace {

constexpr std::size_t kBlockBytes = 32768;

std::vector<Bytef> compress_block(std::span<const std::byte> block) {
  // Level 1: floating-point fields gain little from more, and writing must not hold up the run.
  uLongf length = compressBound(block.size());
  std::vector<Bytef> packed(length);
  const auto* source = reinterpret_cast<const Bytef*>(block.data());
  if (compress2(packed.data(), &length, source, block.size(), 1) != Z_OK) length = 0;
  packed.resize(length);
  return packed;
}

struct Header {
  std::vector<std::uint64_t> block_bytes;       // of each block when unpacked
  std::vector<std::uint64_t> compressed_bytes;  // of each block in the file
  std::size_t characters = 0;                   // of the header's base64
};

std::vector<std::uint64_t> read_words(std::string_view text, std::size_t count) {
  const std::size_t characters = base64_length(count * sizeof(std::uint64_t));
  if (text.size() < characters) throw std::runtime_error("its header is cut off");
  const auto bytes = from_base64(text.substr(0, characters));
  if (bytes.size() < count * sizeof(std::uint64_t)) throw std::runtime_error("its header is damaged");
  std::vector<std::uint64_t> words(count);
  std::memcpy(words.data(), bytes.data(), count * sizeof(std::uint64_t));
  return words;
}

/// The number of blocks stands first, in the first whole base64 groups (3 words = 24 bytes = 32 characters).
Header read_header(std::string_view text, std::size_t expected_bytes) {
  const auto start = read_words(text, 3);
  const std::uint64_t blocks = start[0], full = start[1], last = start[2];
  // The two bounds keep a damaged header's product from overflowing.
  constexpr std::uint64_t kLimit = std::uint64_t{1} << 31;
  const bool fits = blocks == 0 ? expected_bytes == 0
                                : blocks < kLimit && full < kLimit && last < full &&
                                      (blocks - 1) * full + (last > 0 ? last : full) == expected_bytes;
  if (!fits) throw std::runtime_error(fmt::format("its header does not describe {} bytes", expected_bytes));
  Header header;
  const auto words = read_words(text, 3 + blocks);
  header.compressed_bytes.assign(words.begin() + 3, words.end());
  header.block_bytes.assign(blocks, full);
  if (last > 0) header.block_bytes.back() = last;
  header.characters = base64_length(words.size() * sizeof(std::uint64_t));
  return header;
}

}  // namespace

std::string encode_vtk_array(std::span<const std::byte> bytes) {
  const std::size_t blocks = (bytes.size() + kBlockBytes - 1) / kBlockBytes;
  std::vector<std::vector<Bytef>> packed(blocks);
#pragma omp parallel for schedule(static)
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t begin = b * kBlockBytes;
    packed[b] = compress_block(bytes.subspan(begin, std::min(kBlockBytes, bytes.size() - begin)));
  }
  std::vector<std::uint64_t> header{blocks, kBlockBytes, bytes.size() % kBlockBytes};
  std::vector<Bytef> all;
  for (const auto& block : packed) {
    if (block.empty()) throw std::runtime_error("zlib cannot compress a block");
    header.push_back(block.size());
    all.insert(all.end(), block.begin(), block.end());
  }
  std::string text;
  append_base64(text, std::as_bytes(std::span(header)));
  append_base64(text, std::as_bytes(std::span(all)));
  return text;
}

std::vector<std::byte> decode_vtk_array(std::string_view text, std::size_t expected_bytes) {
  const Header header = read_header(text, expected_bytes);
  const auto packed = from_base64(text.substr(header.characters));
  std::vector<std::byte> bytes(expected_bytes);
  std::size_t from = 0, to = 0;
  for (std::size_t b = 0; b < header.block_bytes.size(); ++b) {
    const std::size_t in = header.compressed_bytes[b], out = header.block_bytes[b];
    if (in > packed.size() - from) throw std::runtime_error("its data is cut off");
    uLongf length = out;
    const int status = uncompress(reinterpret_cast<Bytef*>(bytes.data() + to), &length,
                                  reinterpret_cast<const Bytef*>(packed.data() + from), in);
    if (status != Z_OK || length != out) throw std::runtime_error("its compressed data is damaged");
    from += in;
    to += out;
  }
  if (from != packed.size()) throw std::runtime_error("it has more data than its header says");
  return bytes;
}

}  // namespace riven
