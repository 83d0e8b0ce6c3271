// read_map.hpp — reads dense maps of other programs: CCP4/MRC and OpenDX (MAP.md).
#pragma once
#include "compose/dense_map.hpp"
#include <string>
#include <string_view>

namespace molmesh::formats {

/// The bytes of a file, by their content: gzip of either, a text with OpenDX's objects, else CCP4/MRC. Throws
/// Error(bad_input), before memory beyond a multiple of the file's size is taken.
compose::DenseMap read_map(std::string bytes, const std::string& file, int threads = 1);

compose::DenseMap parse_ccp4(std::string_view bytes, const std::string& file, int threads = 1);
compose::DenseMap parse_dx(std::string_view text, const std::string& file);
/// The first bytes of an OpenVDB file.
bool is_vdb(std::string_view bytes);

} // namespace molmesh::formats
