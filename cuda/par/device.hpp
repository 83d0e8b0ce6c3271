// device.hpp — tells whether there is a GPU. Programs include no other file of this room before they need it.
#pragma once
#include <cstdint>
#include <string>

namespace molmesh::cuda {

/// Throws Error(mode_unavailable) when this build has no GPU mode or this machine no device that it can run on.
void require_device();
/// Bytes of the device's memory; 0 where require_device() throws. Asking takes a tenth of a second where there is a
/// device.
int64_t device_memory();
/// "NVIDIA H200, 132 multiprocessors, 139 GiB"; what require_device() throws where there is none.
std::string device_name();
/// Bytes of the host's memory that are free.
int64_t free_host_memory();

} // namespace molmesh::cuda
