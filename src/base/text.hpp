#pragma once

#include <cstdint>
#include <string>

namespace riven {

/// Numbers as people read them, and texts as files hold them.

/// "320 kB", "31 MB", "1.2 GB"
std::string bytes_text(double bytes);
/// "12 s", "3.5 h", "2.4e+03 years"
std::string duration_text(double seconds);
/// "1 thread", "2 threads"
std::string count_text(double count, const std::string& noun);
/// "64 000"
std::string grouped(std::int64_t number);

/// A text as it stands between the marks of HTML and XML, or in an attribute.
std::string escaped(const std::string& text);

}  // namespace riven
