#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

namespace riven {

/// Numbers as a page holds them, {type, count, data}: all first bytes of the numbers, then all second ones
/// and so on, which is where neighbouring numbers agree; zlib; base64.
nlohmann::json packed(std::span<const float> values);
nlohmann::json packed(std::span<const double> values);
nlohmann::json packed(std::span<const std::uint32_t> values);

/// JSON as a page holds it: `<` stands there as \u003c, so that no text ends the page's element; what is no
/// UTF-8 is replaced.
std::string json_text(const nlohmann::json& json);

}  // namespace riven
