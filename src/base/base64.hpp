#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace riven {

/// Characters that so many bytes take, padding included.
std::size_t base64_length(std::size_t bytes);

void append_base64(std::string& text, std::span<const std::byte> bytes);

/// Throws std::runtime_error that says what is wrong; the caller knows the file.
std::vector<std::byte> from_base64(std::string_view text);

}  // namespace riven
