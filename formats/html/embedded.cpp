// embedded.cpp — takes the files in by the assembler, as they are.
#include "formats/html/embedded.hpp"

// MOLMESH_PAGE: their folder; MOLMESH_THREE, MOLMESH_ORBIT_CONTROLS: files, where there are any.
#define EMBED(name, file)                                                                                          \
  __asm__(".section .rodata\n"                                                                                     \
          ".global molmesh_embedded_" #name "\n.global molmesh_embedded_" #name "_end\n"                           \
          "molmesh_embedded_" #name ":\n.incbin \"" file "\"\nmolmesh_embedded_" #name                             \
          "_end:\n.byte 0\n.previous\n");                                                                          \
  extern "C" const char molmesh_embedded_##name[], molmesh_embedded_##name##_end[];                                \
  std::string_view molmesh::formats::embedded::name() {                                                            \
    return {molmesh_embedded_##name,                                                                               \
            static_cast<size_t>(molmesh_embedded_##name##_end - molmesh_embedded_##name)};                         \
  }

EMBED(page_html, MOLMESH_PAGE "/page.html")
EMBED(page_css, MOLMESH_PAGE "/page.css")
EMBED(unpack_js, MOLMESH_PAGE "/unpack.js")
EMBED(view_js, MOLMESH_PAGE "/view.js")
EMBED(page_js, MOLMESH_PAGE "/page.js")
#ifdef MOLMESH_THREE
EMBED(three_js, MOLMESH_THREE)
EMBED(orbit_controls_js, MOLMESH_ORBIT_CONTROLS)
#else
std::string_view molmesh::formats::embedded::three_js() {
  return {};
}
std::string_view molmesh::formats::embedded::orbit_controls_js() {
  return {};
}
#endif
