// embedded.hpp — files that are part of the program: the page, its scripts, three.js.
#pragma once
#include <string_view>

namespace molmesh::formats::embedded {

std::string_view page_html();
std::string_view page_css();
std::string_view unpack_js();
std::string_view view_js();
std::string_view page_js();
/// three.js and its OrbitControls; empty: built without them.
std::string_view three_js();
std::string_view orbit_controls_js();

} // namespace molmesh::formats::embedded
