#pragma once

#include <array>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "exitance/io/scenes/obj/obj.hpp"

namespace exitance {

/// A corner of a scene's face as a weighted mean of corners of the file's face.
struct CornerMean {
    std::array<std::size_t, 3> corner{};  ///< Indices of the file's corners.
    double second = 0, third = 0;         ///< Weights of corners 1 and 2; the first has the rest.

    template <class T>
    T of(std::span<const T> values) const {
        const T& first = values[corner[0]];
        return first + second * (values[corner[1]] - first) + third * (values[corner[2]] - first);
    }
};

/// Matches a scene's faces with those of its OBJ file, by their lines. Faces may have been repaired when they were
/// read.
class ObjMatch {
  public:
    /// Keeps a reference to the scene. Finds the unit of length and the upright axis with which the file was read, from
    /// the largest face that was not cut, or else from the parts of the largest one.
    ObjMatch(const Scene& scene, std::vector<ObjPlaces> faces);

    /// False if the file's faces are not where those of the scene are.
    bool is_aligned() const { return is_aligned_; }
    std::span<const ObjPlaces> faces() const { return faces_; }
    /// The file's face of a scene's face; null if it has none.
    const ObjPlaces* face_of(SurfaceId s) const;
    /// Matches each corner of a face's outline with those of the file's face: the corner there, or a mean of three
    /// corners whose triangle contains the point. None if a point is outside the file's face.
    std::optional<std::vector<CornerMean>> corners(SurfaceId s) const;
    /// Corners of a face of the file in the scene's coordinates.
    std::vector<Point> outline(const ObjPlaces& face) const;
    /// Rotates a direction of the file into the scene's axes.
    Vec3 direction(const Vec3& v) const { return turns_ ? Vec3{v.x, -v.z, v.y} : v; }

  private:
    bool align();
    Point in_scene(const Point& p) const { return scale_ * direction(p); }
    double tolerance() const;
    std::optional<CornerMean> mean_at(const Point& p, std::span<const Point> corners) const;

    const Scene& scene_;
    std::vector<ObjPlaces> faces_;
    std::unordered_map<int, std::size_t> face_of_line_;
    double scale_ = 1;
    bool turns_ = false, is_aligned_ = false;
};

}  // namespace exitance
