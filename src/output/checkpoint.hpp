#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/snapshot.hpp"

namespace riven {

/// Version and instruction set, "0.1.0 (avx2)": another one may give other last digits.
std::string this_program();

/// What a run that stopped goes on from.
struct Checkpoint {
  std::string version = this_program();            // that wrote it
  std::map<std::string, std::string> case_values;  // what determines the run, by key
  Snapshot state;                                  // of model, solver and recorder
};

/// Writes a checkpoint: a page of text with format, version and a checksum over the whole file, then HDF5
/// with one array per name. The file replaces an older one when it is complete and on the disk. Throws
/// RunError when it cannot be written.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Reads it back. Throws InputError for what is no checkpoint, damaged, cut short, or in another format.
Checkpoint read_checkpoint(const std::filesystem::path& path);

}  // namespace riven
