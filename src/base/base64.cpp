#include "base/base64.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>

namespace riven {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t kNoDigit = 255;

constexpr std::array<std::uint8_t, 256> digit_values() {
  std::array<std::uint8_t, 256> values{};
  values.fill(kNoDigit);
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    values[static_cast<std::uint8_t>(kDigits[i])] = static_cast<std::uint8_t>(i);
  return values;
}

}  // namespace

std::size_t base64_length(std::size_t bytes) {
  return (bytes + 2) / 3 * 4;
}

void append_base64(std::string& text, std::span<const std::byte> bytes) {
  text.reserve(text.size() + base64_length(bytes.size()));
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t here = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < here ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += k <= here ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
}

std::vector<std::byte> from_base64(std::string_view text) {
  static constexpr auto kValues = digit_values();
  if (text.size() % 4 != 0) throw std::runtime_error("its base64 text is cut off");
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  std::vector<std::byte> bytes(text.size() / 4 * 3);
  for (std::size_t i = 0; i < text.size(); i += 4) {
    std::uint32_t group = 0;
    for (std::size_t k = i; k < i + 4; ++k) {
      const bool pad = k >= text.size() - padding;
      const std::uint8_t value = pad ? 0 : kValues[static_cast<std::uint8_t>(text[k])];
      if (value == kNoDigit) throw std::runtime_error("its base64 text is damaged");
      group = group << 6 | value;
    }
    for (std::size_t k = 0; k < 3; ++k) bytes[i / 4 * 3 + k] = static_cast<std::byte>(group >> (16 - 8 * k));
  }
  bytes.resize(bytes.size() - padding);
  return bytes;
}

}  // namespace riven
