#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/ids.hpp"
#include "exitance/base/polygon.hpp"
#include "exitance/base/result.hpp"
#include "exitance/base/spectrum.hpp"
#include "exitance/scene/emission_profile.hpp"
#include "exitance/scene/pane.hpp"
#include "exitance/scene/point_light.hpp"
#include "exitance/scene/scene_camera.hpp"
#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

using SurfaceId = Id<struct SurfaceTag>;    ///< One face of the input.
using MaterialId = Id<struct MaterialTag>;  ///< One material of the input.
using GroupId = Id<struct GroupTag>;        ///< One named object of the input.
using RegionId = Id<struct RegionTag>;      ///< Coplanar faces of one material joined along edges.

/// How a surface reflects, diffusely, and emits, diffusely or by a profile. Of a diffusing pane the light that arrives
/// on one side leaves by both: B = rho E + tau E_behind, which is `reflectance` (rho + tau) times
///
///     E_met = (1 - through) E + through E_behind,     through = tau / (rho + tau),
///
/// and that is what counts as a pane's irradiance everywhere.
struct Material {
    std::string name;
    Spectrum reflectance;  ///< Share of the arriving flux that leaves again, in [0, 1).
    Spectrum exitance;     ///< Emitted flux per area, W/m^2 (or lm/m^2).
    DirectedEmission emission = {};
    double through = 0;  ///< Share of that which leaves by the other side, in [0, 1].

    bool emits() const { return max(exitance) > 0; }
    bool is_diffusing_pane() const { return through > 0; }
    bool is_directed() const { return emits() && !emission.profile.is_none(); }
};

/// What takes the place of a reflectance from 1 to `whitest_reflectance`, at which light would never die out. That some
/// programs write 1.0001 for white is rounding; more is an error.
constexpr double mended_reflectance = 0.95, whitest_reflectance = 1.001;

/// Bands that reflect all light are mended. Returns whether any was.
bool mend_reflectance(Spectrum& reflectance);

/// Emitted radiance L_e (W/(m^2 sr)) as exitance M = pi L_e (W/m^2). The one place where radiance becomes exitance.
inline Spectrum exitance_of_radiance(const Spectrum& radiance) {
    return pi * radiance;
}
/// And back, for files that hold radiance.
inline Spectrum radiance_of_exitance(const Spectrum& exitance) {
    return exitance / pi;
}

/// One planar face of the input: one-sided, its corners counter-clockwise seen from the front.
struct Surface {
    std::uint32_t first_corner = 0;
    std::uint32_t corner_count = 0;
    MaterialId material;
    GroupId group;
    RegionId region;
    int line = 0;  ///< Where it stands in the scene file, 0 when it does not come from a file.
    Normal normal;
    double area = 0;  ///< m^2
};

/// Coplanar, edge-sharing faces of one material: for light they are one polygon, however finely it was cut.
struct Region {
    MaterialId material;
    Plane plane;
    double area = 0;  ///< m^2
    std::vector<SurfaceId> surfaces;
    /// Border loops, T-vertices and collinear corners removed: outer loops counter-clockwise seen from the front, holes
    /// clockwise. Metres.
    std::vector<std::vector<Point>> loops;
    /// How many regions of the same plane and orientation lie under parts of it: of two such faces the one that comes
    /// later in the file is on top. At most `most_stacked`.
    std::uint8_t level = 0;
    /// Of a diffusing pane, its other side.
    RegionId behind = {};
};

constexpr std::uint8_t most_stacked = 7;

/// What was found out about an input, for people: `exitance check` prints these.
struct Finding {
    enum class Kind { error, warning, repair };
    Kind kind = Kind::error;
    std::string file;
    int line = 0;
    std::string message;  ///< One sentence holding the offending values, and for a repair what was done.
    std::string hint;     ///< What to do next, or empty.
};

/// Where something was found, for pictures.
struct Mark {
    enum class Kind { broken, left_out, covering, turned, open };
    Kind kind = Kind::broken;
    std::vector<Point> outline;  ///< Of the face, or the two ends of an edge; metres.
};

/// Polygons as a file gives them, not yet looked at.
struct SceneDescription {
    struct Face {
        std::vector<std::uint32_t> corners;  ///< Indices into `points`.
        std::uint32_t material = 0;          ///< Index into `materials`.
        std::uint32_t group = 0;             ///< Index into `groups`.
        int line = 0;
    };
    std::string file;
    std::vector<Point> points;
    std::vector<Material> materials;
    std::vector<EmissionProfile> profiles;  ///< That materials emit by.
    std::vector<std::string> groups;
    std::vector<Face> faces;
    std::vector<PunctualLight> lights;
    DistantLight distant;
    std::vector<Pane> panes;
    std::vector<SceneCamera> cameras;
    bool photometric = false;  ///< Its light is given in lumens rather than watts.
};

/// Polygons with materials, checked and joined to regions. Immutable once made.
class Scene {
  public:
    const std::string& file() const { return file_; }
    const Field<SurfaceId, Surface>& surfaces() const { return surfaces_; }
    const Field<MaterialId, Material>& materials() const { return materials_; }
    const Field<GroupId, std::string>& groups() const { return groups_; }
    const Field<RegionId, Region>& regions() const { return regions_; }

    /// Corners of a face, counter-clockwise seen from its front, metres; planar, without repeated corners.
    std::span<const Point> outline(SurfaceId s) const {
        return std::span(corners_).subspan(surfaces_[s].first_corner, surfaces_[s].corner_count);
    }
    const Material& material(SurfaceId s) const { return materials_[surfaces_[s].material]; }
    const Material& material(RegionId r) const { return materials_[regions_[r].material]; }

    /// Of a region of a diffusing pane, its other side; else none.
    RegionId behind(RegionId r) const { return r.is_none() ? r : regions_[r].behind; }
    /// Are there surfaces that light passes diffusely?
    bool has_diffusing_panes() const {
        return std::any_of(regions_.begin(), regions_.end(), [](const Region& r) { return !r.behind.is_none(); });
    }

    const Box& box() const { return box_; }
    double size() const { return box_.diagonal(); }  ///< Diagonal of its box, metres.

    /// How light leaves a region's front: its radiance by direction, over that of a diffuse one.
    RelativeRadiance relative_radiance(RegionId r) const {
        const Material& m = material(r);
        return m.is_directed() ? RelativeRadiance(profiles_[m.emission.profile], m.emission, regions_[r].plane.n)
                               : RelativeRadiance();
    }
    const Field<ProfileId, EmissionProfile>& profiles() const { return profiles_; }
    /// Is there anything that emits, and not diffusely?
    bool has_directed_emission() const {
        return std::any_of(emitters_.begin(), emitters_.end(), [&](SurfaceId s) { return material(s).is_directed(); });
    }

    /// Faces that emit, in the order of their ids.
    const std::vector<SurfaceId>& emitters() const { return emitters_; }
    /// Sources without extent, in the order of the file.
    const std::vector<PunctualLight>& lights() const { return lights_; }
    /// Clear glass, cut to convex polygons.
    const std::vector<Pane>& panes() const { return panes_; }
    /// Skies and suns.
    const DistantLight& distant() const { return distant_; }
    /// As users say who want another light from outside.
    void put_under(DistantLight light) { distant_ = std::move(light); }
    /// As users say who dim lamps and paint walls: how a material reflects and what it emits from now on. Faces that
    /// emit nothing are no emitters any more.
    void relight(MaterialId m, const Spectrum& reflectance, const Spectrum& exitance);
    void put_lights(std::vector<PunctualLight> lights) { lights_ = std::move(lights); }
    bool has_light() const { return !emitters_.empty() || has_light_apart(); }
    /// Is there light that no surface sends, so that rays from surface to surface do not find it?
    bool has_light_apart() const { return !lights_.empty() || !distant_.empty(); }
    /// Is there light that comes from outside, so that what is emitted is what arrives?
    bool has_light_from_outside() const {
        return !distant_.empty() || std::any_of(lights_.begin(), lights_.end(),
                                                [](const PunctualLight& light) { return light.is_directional(); });
    }

    /// Is light measured in lumens rather than watts? Nothing is converted: E is in lx, then, and M in lm/m^2.
    bool is_photometric() const { return photometric_; }
    /// As users say who know better than the file.
    void declare_photometric(bool photometric) { photometric_ = photometric; }

    /// Views that came with the scene; nothing but pictures takes note of them.
    const std::vector<SceneCamera>& cameras() const { return cameras_; }

  private:
    friend class SceneBuilder;
    friend class StoredScene;  ///< Restores a scene bit for bit from a solution's file.
    std::string file_;
    Field<SurfaceId, Surface> surfaces_;
    Field<MaterialId, Material> materials_;
    Field<ProfileId, EmissionProfile> profiles_;
    Field<GroupId, std::string> groups_;
    Field<RegionId, Region> regions_;
    std::vector<Point> corners_;
    std::vector<SurfaceId> emitters_;
    std::vector<PunctualLight> lights_;
    DistantLight distant_;
    std::vector<Pane> panes_;
    std::vector<SceneCamera> cameras_;
    bool photometric_ = false;
    Box box_;
};

/// A scene, unless a finding is an error, and everything that was found on the way.
struct CheckedScene {
    Result<Scene> scene;
    std::vector<Finding> findings;  ///< Errors first, then in the order of the file.
    std::vector<Mark> marks = {};   ///< Of all faces that findings are about, those too that are only counted.
};

/// Checks every face and material, repairs what has a safe repair (and says so), joins coplanar neighbours to regions.
/// A scene without faces, or with any error, is not made. O(n log n).
CheckedScene make_scene(SceneDescription description);

}  // namespace exitance
