// device_report.hpp — a run on the device as JSON, for the run report.
#pragma once
#include "cuda/par/backend.hpp"
#include <nlohmann/json.hpp>

namespace molmesh::cuda {

inline nlohmann::ordered_json json(const DeviceReport& r) {
  nlohmann::ordered_json kernels = nlohmann::ordered_json::array();
  for (const KernelTime& k : r.kernels)
    kernels.push_back({{"name", k.name},
                       {"launches", k.launches},
                       {"items", k.items},
                       {"seconds", k.seconds},
                       {"bytes", k.work.bytes},
                       {"multiply_adds", k.work.multiply_adds},
                       {"in_double", k.work.in_double}});
  nlohmann::ordered_json out = {{"name", r.device},
                                {"most_bytes", r.most_used.own},
                                {"most_paged_bytes", r.most_used.paged},
                                {"kernels", kernels}};
  if (!r.note.empty())
    out["note"] = r.note;
  return out;
}

} // namespace molmesh::cuda
