// control_groups.cpp — reads /proc/self/cgroup: lines number:controllers:group; version 2 names no controllers.
#include "base/control_groups.hpp"
#include <fstream>

namespace molmesh {

void for_each_group(const SystemFiles& system, const std::string& controller,
                    const std::function<void(const std::filesystem::path& folder, int version)>& look) {
  std::ifstream in(system.proc / "self/cgroup");
  for (std::string line; std::getline(in, line);) {
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos)
      continue;
    const std::string controllers = ',' + line.substr(first + 1, second - first - 1) + ',';
    const int version = controllers == ",," ? 2 : 1;
    if (version == 1 && controllers.find(',' + controller + ',') == std::string::npos)
      continue;
    std::filesystem::path at = version == 2 ? system.groups : system.groups / controller;
    look(at, version);
    for (const auto& name : std::filesystem::path(line.substr(second + 1)).relative_path())
      look(at /= name, version);
  }
}

} // namespace molmesh
