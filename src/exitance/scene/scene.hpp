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
#include "exitance/scene/luminaire.hpp"
#include "exitance/scene/pane.hpp"
#include "exitance/scene/point_light.hpp"
#include "exitance/scene/scene_camera.hpp"
#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

using SurfaceId = Id<struct SurfaceTag>;    ///< One face of the input.
using MaterialId = Id<struct MaterialTag>;  ///< One material of the input.
using GroupId = Id<struct GroupTag>;        ///< One named object of the input.
using RegionId = Id<struct RegionTag>;      ///< Coplanar faces of one material joined along edges.

/// Diffuse reflection and diffuse or directional emission of a surface. On a diffusing pane, light that arrives on one
/// side leaves by both: B = rho E + tau E_behind. This is `reflectance` (rho + tau) times
///
///     E_met = (1 - through) E + through E_behind,     through = tau / (rho + tau),
///
/// and E_met is used as the pane's irradiance everywhere.
struct Material {
    std::string name;
    Spectrum reflectance;  ///< Share of the incident flux that is reflected (and transmitted), in [0, 1).
    Spectrum exitance;     ///< Emitted flux per area, W/m^2 (or lm/m^2).
    DirectedEmission emission = {};
    double through = 0;  ///< Share of the reflected flux that leaves by the other side (diffusing panes), in [0, 1].

    bool emits() const { return max(exitance) > 0; }
    bool is_diffusing_pane() const { return through > 0; }
    bool is_directed() const { return emits() && !emission.profile.is_none(); }
};

/// A reflectance from 1 to `whitest_reflectance`, at which light would never decay, is replaced by
/// `mended_reflectance`. Values such as 1.0001 for white are rounding errors of some programs; larger ones are an
/// error.
constexpr double mended_reflectance = 0.95, whitest_reflectance = 1.001;

/// Replaces reflectances of bands by `mended_reflectance` as described above. Returns true if there was one to replace.
bool mend_reflectance(Spectrum& reflectance);

/// Converts emitted radiance L_e (W/(m^2 sr)) to exitance M = pi L_e (W/m^2). The only place with this conversion.
inline Spectrum exitance_of_radiance(const Spectrum& radiance) {
    return pi * radiance;
}
/// Converts exitance to radiance, for files that store radiance.
inline Spectrum radiance_of_exitance(const Spectrum& exitance) {
    return exitance / pi;
}

/// One planar, one-sided face of the input; its corners are counter-clockwise seen from the front.
struct Surface {
    std::uint32_t first_corner = 0;
    std::uint32_t corner_count = 0;
    MaterialId material;
    GroupId group;
    RegionId region;
    int line = 0;  ///< Line in the scene file; 0 if it does not come from a file.
    Normal normal;
    double area = 0;          ///< m^2
    std::uint32_t whole = 0;  ///< For a part of a textured face: a number that all parts of that face share; else 0.
};

/// Coplanar, edge-sharing faces of one material, treated as one polygon however finely it was subdivided.
struct Region {
    MaterialId material;
    Plane plane;
    double area = 0;  ///< m^2
    std::vector<SurfaceId> surfaces;
    /// Border loops without T-vertices and collinear corners: outer loops counter-clockwise seen from the front, holes
    /// clockwise. Metres.
    std::vector<std::vector<Point>> loops;
    /// Number of regions of the same plane and orientation that are under parts of it, at most `max_stacked`. Of two
    /// overlapping faces, one that emits light is on top of one that does not; otherwise the later one in the file is.
    std::uint8_t level = 0;
    /// Other side of a diffusing pane; none for other regions.
    RegionId behind = {};
};

constexpr std::uint8_t max_stacked = 7;

/// Faces closer than this count as coplanar, as a share of the scene's size and of the smaller face's box.
constexpr double coplanar_share = 1e-6, coplanar_share_of_face = 1e-3;

/// Cosine of the angle between normals, 2.6 degrees, from which faces that are near to each other count as parallel.
/// Derived from coplanar_share_of_face: the normals of coplanar faces differ by up to 0.1 degrees.
constexpr double parallel_cosine = 0.999;

/// A diagnostic about an input for the user, printed by `exitance check`.
struct Finding {
    enum class Kind { error, warning, repair };
    Kind kind = Kind::error;
    std::string file;
    int line = 0;
    std::string message;  ///< One sentence with the offending values; for a repair, also a description of the change.
    std::string hint;     ///< Suggested action, or empty.
};

/// Location of a finding, for pictures.
struct Mark {
    enum class Kind { broken, left_out, covering, turned, open };
    Kind kind = Kind::broken;
    std::vector<Point> outline;  ///< The face, or the two ends of an edge; metres.
};

/// Unchecked polygons and lights as given by a file.
struct SceneDescription {
    struct Face {
        std::vector<std::uint32_t> corners;  ///< Indices into `points`.
        std::uint32_t material = 0;          ///< Index into `materials`.
        std::uint32_t group = 0;             ///< Index into `groups`.
        int line = 0;
        std::uint32_t whole = 0;  ///< For a part of a face: a number that all parts of that face share; else 0.
    };
    std::string file;
    std::vector<Point> points;
    std::vector<Material> materials;
    std::vector<EmissionProfile> profiles;  ///< Emission profiles used by materials.
    std::vector<std::string> groups;
    std::vector<Face> faces;
    std::vector<PunctualLight> lights;
    DistantLight distant;
    std::vector<Pane> panes;
    std::vector<SceneCamera> cameras;
    std::vector<LuminaireType> luminaire_types;
    std::vector<InstalledLuminaire> luminaires;
    bool photometric = false;  ///< The light is in lumens, not watts.
};

/// Polygons with materials, checked and joined to regions. Geometry is immutable.
class Scene {
  public:
    const std::string& file() const { return file_; }
    const Field<SurfaceId, Surface>& surfaces() const { return surfaces_; }
    const Field<MaterialId, Material>& materials() const { return materials_; }
    const Field<GroupId, std::string>& groups() const { return groups_; }
    const Field<RegionId, Region>& regions() const { return regions_; }

    /// Returns the corners of a face, counter-clockwise seen from its front, metres; planar, without repeated corners.
    std::span<const Point> outline(SurfaceId s) const {
        return std::span(corners_).subspan(surfaces_[s].first_corner, surfaces_[s].corner_count);
    }
    const Material& material(SurfaceId s) const { return materials_[surfaces_[s].material]; }
    const Material& material(RegionId r) const { return materials_[regions_[r].material]; }

    /// Returns the other side of a region of a diffusing pane; else none.
    RegionId behind(RegionId r) const { return r.is_none() ? r : regions_[r].behind; }
    /// True if there are surfaces that transmit light diffusely.
    bool has_diffusing_panes() const {
        return std::any_of(regions_.begin(), regions_.end(), [](const Region& r) { return !r.behind.is_none(); });
    }

    const Box& box() const { return box_; }
    double size() const { return box_.diagonal(); }  ///< Diagonal of the scene's bounding box, metres.

    /// Returns the directional distribution of a region's emission, relative to a diffuse emitter.
    RelativeRadiance relative_radiance(RegionId r) const {
        const Material& m = material(r);
        return m.is_directed() ? RelativeRadiance(profiles_[m.emission.profile], m.emission, regions_[r].plane.n)
                               : RelativeRadiance();
    }
    const Field<ProfileId, EmissionProfile>& profiles() const { return profiles_; }
    /// True if some emitter is not diffuse.
    bool has_directed_emission() const {
        return std::any_of(emitters_.begin(), emitters_.end(), [&](SurfaceId s) { return material(s).is_directed(); });
    }

    /// Returns the faces that emit, sorted by id.
    const std::vector<SurfaceId>& emitters() const { return emitters_; }
    /// Returns the punctual lights, in the order of the file.
    const std::vector<PunctualLight>& lights() const { return lights_; }
    /// Returns the panes of clear glass, split into convex polygons.
    const std::vector<Pane>& panes() const { return panes_; }
    /// Replaces the transmissivity of every pane by t(pane), which must be in [0, 1] for every band.
    template <class Transmissivity>
    void set_transmissivities(const Transmissivity& t) {
        for (Pane& pane : panes_) pane.transmissivity = t(pane);
    }
    /// Returns the skies and suns.
    const DistantLight& distant() const { return distant_; }
    /// Replaces the light from outside.
    void put_under(DistantLight light) { distant_ = std::move(light); }
    /// Changes the reflectance and exitance of a material. Faces that no longer emit are removed from emitters().
    void relight(MaterialId m, const Spectrum& reflectance, const Spectrum& exitance);
    void put_lights(std::vector<PunctualLight> lights) { lights_ = std::move(lights); }
    bool has_light() const { return !emitters_.empty() || has_light_apart(); }
    /// True if there is light that no surface emits, so that rays between surfaces do not sample it.
    bool has_light_apart() const { return !lights_.empty() || !distant_.empty(); }
    /// True if light comes from outside, so that the emitted flux is only the part that arrives.
    bool has_light_from_outside() const {
        return !distant_.empty() || std::any_of(lights_.begin(), lights_.end(),
                                                [](const PunctualLight& light) { return light.is_directional(); });
    }

    /// True if light is in lumens rather than watts. Nothing is converted: E is in lx, M in lm/m^2.
    bool is_photometric() const { return photometric_; }
    /// Overrides the unit given in the file.
    void declare_photometric(bool photometric) { photometric_ = photometric; }

    /// Returns the views that came with the scene; used only for pictures.
    const std::vector<SceneCamera>& cameras() const { return cameras_; }
    /// Returns the luminaires with photometric files, in the order of the input, and their types; used only for
    /// reports.
    const std::vector<InstalledLuminaire>& luminaires() const { return luminaires_; }
    const std::vector<LuminaireType>& luminaire_types() const { return luminaire_types_; }

  private:
    friend class SceneBuilder;
    friend class StoredScene;  ///< Restores a scene bit for bit from a solution file.
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
    std::vector<LuminaireType> luminaire_types_;
    std::vector<InstalledLuminaire> luminaires_;
    bool photometric_ = false;
    Box box_;
};

/// A scene, unless a finding is an error, and all findings.
struct CheckedScene {
    Result<Scene> scene;
    std::vector<Finding> findings;  ///< Errors first, then in the order of the file.
    std::vector<Mark> marks = {};   ///< Marks of all faces with findings, including those that are only counted.
};

/// Checks all faces and materials, repairs problems that have a safe repair (and reports it), and joins coplanar
/// neighbours to regions. There is no scene if it has no faces or any error. O(n log n).
CheckedScene make_scene(SceneDescription description);

}  // namespace exitance
