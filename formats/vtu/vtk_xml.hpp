// vtk_xml.hpp — the elements of a VTK XML file and where their data lie. Rules R1 to R3 of VTUv1.md.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace molmesh::formats::vtk {

enum class ValueType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };
enum class Encoding { ascii, inline_base64, appended_raw, appended_base64 };

/// A DataArray as declared, its data not yet decoded.
struct ArrayTag {
  std::string name;
  ValueType type{};
  Encoding encoding{};
  int components = 1;
  int64_t line = 0;      ///< of its start tag
  int64_t offset = 0;    ///< appended: from the underscore
  std::string_view data; ///< text between the tags, or all that follows its offset in AppendedData
};

struct Piece {
  int64_t line = 0, points = 0, cells = 0;
  std::vector<ArrayTag> point{}, cell{}, cell_data{}; ///< children of Points, Cells, CellData
};

struct Document {
  const std::string& file; ///< for messages
  std::string_view text;
  bool big_endian = false, zlib = false;
  int header_bytes = 4;
  std::vector<ArrayTag> field{}; ///< children of FieldData
  std::vector<Piece> piece{};

  /// "FILE:LINE: RULE: what". Throws Error(bad_input).
  [[noreturn]] void refuse(int64_t line, const char* rule, const std::string& what) const;
  /// Line of a place in the text.
  int64_t line_of(const char* place) const;
};

/// The views in the document point into `text`. Arrays of types that are no numbers (String) are left out.
Document parse_document(const std::string& file, std::string_view text);

} // namespace molmesh::formats::vtk
