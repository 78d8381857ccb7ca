#pragma once

#include <vector>

#include "exitance/measure/light_maps/curved_faces.hpp"
#include "exitance/solution/solution.hpp"

namespace exitance {

/// Mean irradiance of a curved region in its map and in the solution, which has flat faces.
struct CurvedDifference {
    RegionId region;
    double area = 0;               ///< m^2
    double baked = 0, solved = 0;  ///< Mean over the region and over bands, W/m^2.

    double value() const { return baked - solved; }
};

/// Differences of all curved regions of a scene.
struct CurvedDifferences {
    std::vector<CurvedDifference> regions;  ///< Differences of the curved regions, in the order of their ids.

    bool empty() const { return regions.empty(); }
    /// RMS of the differences, relative to the RMS of the solution's irradiance on these regions; both weighted by
    /// area.
    double rms() const;
    /// The largest difference in relation to the same RMS.
    double largest() const;

  private:
    double level() const;
};

/// Sums the light of the texels of curved regions.
class CurvedSums {
  public:
    /// `faces`: null if no region is curved.
    CurvedSums(const Scene& scene, const CurvedFaces* faces);

    /// Adds the light of a part of a texel. `area`: m^2; `irradiance`: 0 where it is covered.
    void add(RegionId region, double area, const Spectrum& irradiance);
    /// Compares the sums with the solution's interpolant. O(elements).
    CurvedDifferences compare(const Solution& solution) const;

  private:
    const CurvedFaces* faces_;
    struct Sum {
        double area = 0, flux = 0;
    };
    Field<RegionId, Sum> sums_;
};

}  // namespace exitance
