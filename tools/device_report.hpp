// device_report.hpp — a run on the device, for the run report.
#pragma once
#include "cli/value.hpp"
#include "cuda/par/backend.hpp"

namespace molmesh {

inline cli::Value device_value(const cuda::DeviceReport& r) {
  cli::Value::List kernels;
  for (const cuda::KernelTime& k : r.kernels)
    kernels.push_back({{"name", k.name},
                       {"launches", k.launches},
                       {"items", k.items},
                       {"seconds", k.seconds},
                       {"bytes", k.work.bytes},
                       {"multiply_adds", k.work.multiply_adds},
                       {"in_double", k.work.in_double}});
  cli::Value out = {{"name", r.device},
                    {"most_bytes", r.most_used.own},
                    {"most_paged_bytes", r.most_used.paged},
                    {"kernels", kernels}};
  if (!r.note.empty())
    out["note"] = r.note;
  return out;
}

} // namespace molmesh
