#pragma once

#include <span>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/links/kept_link.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Links as a glTF scene of lines (.glb, Y up, metres): the outlines of receivers and sources, and a line from the
/// middle of one to that of the other for each link; a mesh and an unlit colour each.
Result<void> write_links_glb(const ElementTree& tree, std::span<const ElementId> receivers,
                             std::span<const ElementId> sources, std::span<const KeptLink> links,
                             const std::string& path);

}  // namespace exitance
