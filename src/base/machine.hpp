#pragma once

#include <filesystem>

namespace riven {

/// Memory (bytes) that the program can still take: what the kernel calls available, or what a control group
/// leaves of its limit if that is less; infinite where the system does not say. `root`: of the file system.
double available_memory(const std::filesystem::path& root = "/");

/// Bytes that are free for this user on the disk that would hold `path`, which need not be there yet.
double available_disk(const std::filesystem::path& path);

}  // namespace riven
