#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace riven {

/// Content of a VTK XML data array with header_type UInt64 and vtkZLibDataCompressor: a base64 header (number
/// of blocks, bytes per block, bytes of the last block if shorter, compressed bytes of each), then the base64
/// of all compressed blocks.
std::string encode_vtk_array(std::span<const std::byte> bytes);

/// The inverse. `expected_bytes` is known from the number of points, so that a damaged header cannot ask for
/// any amount of memory. Throws std::runtime_error that says what is wrong; the caller knows the file.
std::vector<std::byte> decode_vtk_array(std::string_view text, std::size_t expected_bytes);

}  // namespace riven
