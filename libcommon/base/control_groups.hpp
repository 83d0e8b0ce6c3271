// control_groups.hpp — finds the limits that containers and batch systems set to this process.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace molmesh {

/// Where the system says what it grants.
struct SystemFiles {
  std::filesystem::path proc = "/proc", groups = "/sys/fs/cgroup";
};

/// look(folder, version) for the folder of every control group around this process, outermost first, that may hold
/// the limits of a controller ("memory", "cpu"). version: 1 or 2, whose files have different names.
void for_each_group(const SystemFiles& system, const std::string& controller,
                    const std::function<void(const std::filesystem::path& folder, int version)>& look);

} // namespace molmesh
