#pragma once

#include <span>

#include "exitance/direct/direct_light.hpp"
#include "exitance/mesh/discontinuity/six_node_mesh.hpp"

namespace exitance {

/// Share of a source's form factor below which nothing of the source is visible, and up to which it may be hidden
/// while all of it counts as visible: blockers that only touch the lines of sight cast no shadow. Derived from the
/// rounding of form factors, 1e-12, and from corners of triangles, which are off their curves by 1e-7 of the scene.
inline constexpr double touching_share = 1e-6;

/// Classifies a point by its exact view of the sources: it sees all of every source that its front faces (lit), nothing
/// of any (umbra), or else parts (penumbra). Panes hide nothing. Needs exact visible parts only of sources with
/// candidates, and stops at the first proof of a penumbra. About 1-5 microseconds per source.
/// light  sources and candidates of a polygon that contains x
/// among  the sources that `light` was prepared from
ShadowClass shadow_class_at(const DirectLight& direct, const ReceiverLight& light, const Point& x,
                            std::span<const DirectLight::SourceName> among, DirectLight::Workspace& workspace);

/// Like the function above, if `light` was prepared from all emitters and punctual lights.
ShadowClass shadow_class_at(const DirectLight& direct, const ReceiverLight& light, const Point& x,
                            DirectLight::Workspace& workspace);

}  // namespace exitance
