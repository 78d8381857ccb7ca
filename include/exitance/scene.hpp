#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "exitance/error.hpp"
#include "exitance/spectrum.hpp"
#include "exitance/vec.hpp"

namespace exitance::api {

/// Diffuse reflection and emission of faces.
struct Material {
    std::string name;
    Spectrum reflectance;  ///< Share of the incident light that is reflected, in [0, 1).
    Spectrum exitance;     ///< Emitted flux per area, W/m^2: pi times the emitted radiance.
};

/// Polygons with materials. Faces are one-sided: their corners are counter-clockwise seen from their front.
struct SceneDescription {
    std::vector<Vec3> vertices;                ///< Metres.
    std::vector<std::uint32_t> corners;        ///< Indices into `vertices`, face by face.
    std::vector<std::uint32_t> corner_counts;  ///< Number of corners per face, at least 3.
    std::vector<Material> materials;
    std::vector<std::uint32_t> material;  ///< Per face: an index into `materials`.
    /// Names of groups of faces. Emitting faces of one group can be dimmed together (Solution::mix).
    std::vector<std::string> groups;
    std::vector<std::uint32_t> group;  ///< Per face: an index into `groups`; empty: all faces are in the first one.
    bool photometric = false;          ///< Emission is in lumens instead of watts.
    std::string sky = {};              ///< Light from outside, as in LoadOptions; empty: none.
    std::string epw = {};              ///< Weather file with place and irradiances for `sky`; empty: none.
    bool light_groups = false;         ///< See LoadOptions::light_groups.
};

/// A diagnostic about a scene.
struct Finding {
    enum class Kind { error, warning, repair };
    Kind kind = Kind::warning;
    std::string where;    ///< File and line, or empty.
    std::string message;  ///< One sentence; for a repair, it includes the change.
    std::string hint;     ///< Suggested action, or empty.
};

/// One face of a scene.
struct Face {
    std::vector<Vec3> outline;  ///< Corners, counter-clockwise seen from the front, metres.
    Vec3 normal;                ///< Unit vector to the front.
    double area = 0;            ///< m^2
    std::size_t material = 0;   ///< Index into Scene::materials().
    std::size_t group = 0;      ///< Index into Scene::groups().
};

struct SceneData;

/// A checked, immutable scene: polygons with materials, lights, skies. Copies share their data.
class Scene {
  public:
    /// Number of faces after repairs.
    std::size_t size() const;
    /// Face `index`, in the order of the input. `index` must be below size().
    Face face(std::size_t index) const;
    std::vector<Material> materials() const;
    /// Names of the groups of faces.
    std::vector<std::string> groups() const;
    /// Total area of the faces, m^2.
    double area() const;
    /// Corners of the bounding box, metres. Both are zero if the scene has no faces.
    Vec3 lowest() const;
    Vec3 highest() const;
    /// True if something emits light.
    bool has_light() const;
    /// True if the emitters of each group are kept apart, so that solve() also solves each group.
    bool has_light_groups() const;
    /// True if the light is in lumens (results in lx), false if it is in watts (results in W/m^2).
    bool is_photometric() const;
    /// Warnings and repairs of the input. Empty for the scene of a solution.
    const std::vector<Finding>& findings() const;

    /// For the library.
    explicit Scene(std::shared_ptr<const SceneData> data) : data_(std::move(data)) {}
    const SceneData& data() const { return *data_; }

  private:
    std::shared_ptr<const SceneData> data_;
};

/// Checks and repairs a scene, and joins coplanar neighbours. Gives the same light, to the last bit, as a file with the
/// same content.
/// Errors: usage if array sizes or indices do not fit together; bad_input for faces and materials that cannot be
/// repaired. O(n log n).
Result<Scene> make_scene(const SceneDescription& description);

}  // namespace exitance::api
