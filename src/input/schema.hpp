#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace riven {

/// JSON Schema (draft 2020-12) of the case format, for editors.
nlohmann::ordered_json case_schema();

/// The reference page of the case format (docs/reference.md), in Markdown.
std::string reference_page();

}  // namespace riven
