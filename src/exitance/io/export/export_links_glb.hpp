#pragma once

#include <span>
#include <string>

#include "exitance/base/result.hpp"
#include "exitance/links/kept_link.hpp"
#include "exitance/mesh/element_tree.hpp"

namespace exitance {

/// Writes links as a glTF scene of lines (.glb, Y up, metres): the outlines of receivers, the outlines of sources, and
/// a line between the centres of each link's elements. Each of the three is a mesh with its own unlit colour.
Result<void> write_links_glb(const ElementTree& tree, std::span<const ElementId> receivers,
                             std::span<const ElementId> sources, std::span<const KeptLink> links,
                             const std::string& path);

}  // namespace exitance
