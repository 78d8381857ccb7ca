#pragma once

#include <optional>

#include "exitance/base/progress.hpp"
#include "exitance/what_if/daylight/daylight_transport.hpp"
#include "exitance/what_if/daylight/visible_patches.hpp"

namespace exitance {

/// Settings of a daylight matrix. Rays are those of all replicates together.
struct DaylightOptions {
    double elements = 6000;         ///< Approximate number of elements for interreflection.
    double rays_an_element = 256;   ///< Average number of rays per element.
    unsigned rays_a_sensor = 2048;  ///< Rays per sensor for reflected light; a power of two.
    std::uint64_t seed = 1;
};

/// Light of every patch of the sky at every sensor: lx per cd/m^2 (or W/m^2 per W/(m^2 sr)), bands weighted by
/// `luminous_weights()`.
struct DaylightMatrix {
    std::size_t patches = 0;
    std::vector<float> direct;     ///< Row by row, one per sensor: light that arrives from the sky, also through glass.
    std::vector<float> reflected;  ///< Light after at least one reflection: the mean of the replicates.
    std::array<std::vector<float>, daylight_replicates> replicates;  ///< Independent estimates of `reflected`.
    /// Per group of panes: the part of the light that has crossed panes of the group.
    std::vector<DaylightMatrix> through;

    void resize(std::size_t sensors, std::size_t patch_count);
    std::size_t sensors() const { return patches > 0 ? direct.size() / patches : 0; }
    double total(std::size_t sensor, std::size_t patch) const {
        return double(direct[sensor * patches + patch]) + double(reflected[sensor * patches + patch]);
    }
};

/// A sensor whose rays were cast and whose visible patches were found before.
struct KnownSensor {
    SensorRays rays;
    std::vector<float> direct;  ///< Irradiance by every patch with luminance 1.
};

/// Computes rows of a daylight matrix: the exact visible part of every patch at a sensor, and a gather of reflected
/// light by rays.
class DaylightRows {
  public:
    /// `light`: a column per patch. `through`: the parts of it that have crossed panes of each group; empty if these
    /// are not needed. All arguments must outlive this object.
    DaylightRows(const DaylightTransport& transport, const ElementLight& light, const SkyPatches& patches,
                 unsigned rays_a_sensor, std::span<const ElementLight> through = {})
        : transport_(transport),
          light_(light),
          through_(through),
          visible_(transport.stage().occluders, patches),
          rays_a_sensor_(rays_a_sensor) {}

    /// Computes the rows of consecutive sensors, of which `first` is the number of the first. `known`: returns stored
    /// data of a sensor, or null. O(sensors x (rays + patches)).
    template <class Known>
    DaylightMatrix rows(std::span<const SurfacePoint> sensors, std::size_t first, const Known& known) const {
        std::vector<const KnownSensor*> found;
        for (std::size_t i = 0; i < sensors.size(); ++i) found.push_back(known(first + i));
        return rows_of(sensors, first, found);
    }

  private:
    DaylightMatrix rows_of(std::span<const SurfacePoint> sensors, std::size_t first,
                           std::span<const KnownSensor* const> known) const;
    void find_through(const SurfacePoint& sensor, std::size_t i, const SensorRays& rays,
                      VisiblePatches::Workspace& workspace, DaylightMatrix& out) const;

    const DaylightTransport& transport_;
    const ElementLight& light_;
    std::span<const ElementLight> through_;
    VisiblePatches visible_;
    unsigned rays_a_sensor_;
};

}  // namespace exitance
