// region_order.cpp — reads the numbers of the text.
#include "mesh/region_order.hpp"
#include <algorithm>
#include <charconv>
#include <string_view>

namespace molmesh {

RegionOrder::RegionOrder(const TetMesh& m) {
  if (std::none_of(m.named_text.begin(), m.named_text.end(),
                   [](const NamedText& t) { return t.name == region_level_text; }))
    return;
  for (const NamedText& t : m.named_text)
    if (t.name == region_names_text)
      for (std::string_view rest = t.text; !rest.empty();) {
        const std::string_view line = rest.substr(0, rest.find('\n'));
        rest.remove_prefix(std::min(rest.size(), line.size() + 1));
        int32_t id = 0;
        if (std::from_chars(line.data(), line.data() + line.size(), id).ec == std::errc())
          last_domain = std::max(last_domain, id);
      }
}

} // namespace molmesh
