#pragma once

#include <span>
#include <vector>

#include "exitance/base/disjoint_sets.hpp"
#include "exitance/what_if/daylight/bright_elements.hpp"

namespace exitance {

/// The parts of a view that can be sources of glare in some hour of a year: of the sky and the ground by patch, and of
/// the elements that are ever bright. All visible parts are exact. In an hour, the parts above the threshold are
/// joined to sources as by join_glare_parts().
class GlareView {
  public:
    /// `eye`: not on a surface. All arguments must outlive this object. About 10 ms.
    GlareView(const DaylightTransport& transport, const SkyPatches& patches, const BrightElements& bright,
              const SurfacePoint& eye);

    /// Arrays for terms(), reused.
    struct Workspace {
        std::vector<float> luminance;
        std::vector<std::uint32_t> lit;
        DisjointSets sets;
    };
    /// Returns the sum of L^2 omega / P^2 over the sources of an hour, without the sun. `sky`: luminances of the
    /// patches; `elements`: the bright elements; `threshold`: cd/m^2.
    double terms(std::span<const float> sky, std::span<const BrightElements::Entry> elements, double threshold,
                 Workspace& workspace) const;

  private:
    /// A connected part with one luminance outside of the panes: that of a patch or an element.
    struct Part {
        std::uint32_t patch = 0;  ///< Number of the patch, or of patches plus that of the element.
        double solid_angle = 0;   ///< sr
        double transmission = 0;  ///< Mean over the part.
        Vec3 centre;              ///< Integral of the direction times the transmission, sr.
        std::uint32_t next = 0;   ///< End of the range of its neighbours.
    };
    struct Piece;
    std::vector<Piece> visible_pieces(const DaylightTransport& transport, const SkyPatches& patches,
                                      const BrightElements& bright) const;
    void join(const std::vector<Piece>& pieces);
    void collect(std::span<const float> sky, std::span<const BrightElements::Entry> elements, double threshold,
                 Workspace& workspace) const;

    const SurfacePoint eye_;
    std::size_t patches_;
    std::vector<Part> parts_;                ///< Parts, sorted by patch.
    std::vector<std::uint32_t> neighbours_;  ///< Earlier parts within a step, part by part.
    std::size_t sky_parts_ = 0;              ///< Number of parts of the sky and the ground; they come first.
};

}  // namespace exitance
