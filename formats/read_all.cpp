// read_all.cpp — in one piece where the size is known, else growing.
#include "formats/read_all.hpp"
#include "base/error.hpp"
#include "par/pages.hpp"
#include <algorithm>
#include <istream>

namespace molmesh::formats {

std::string read_all(std::istream& in, const std::string& file) {
  constexpr size_t step = size_t{1} << 20;
  std::string text;
  const auto start = in.tellg();
  if (start >= 0 && in.seekg(0, std::ios::end)) {
    const auto size = static_cast<size_t>(std::max<std::streamoff>(in.tellg() - start, 0));
    text.reserve(size + step); // the last step finds the end
    prepare_pages(text.data(), size);
    in.seekg(start);
  }
  in.clear();
  for (size_t size = 0;;) {
    text.resize(size + step);
    in.read(text.data() + size, step);
    size += static_cast<size_t>(in.gcount());
    if (static_cast<size_t>(in.gcount()) < step) {
      text.resize(size);
      break;
    }
  }
  if (in.bad())
    fail_input(file + ": cannot read");
  return text;
}

} // namespace molmesh::formats
