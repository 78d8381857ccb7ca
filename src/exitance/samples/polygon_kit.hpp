#pragma once

#include <array>
#include <string>
#include <string_view>
#include <unordered_map>

#include "exitance/scene/scene.hpp"

namespace exitance {

/// A rotation about the vertical axis, followed by a translation.
struct Placement {
    Vec3 move;
    double cosine = 1, sine = 0;

    /// Rotates by `degrees` (multiples of 90 are exact), then translates to (x, y, z).
    static Placement at(double x, double y, double z, double degrees = 0);
    Point operator()(const Point& p) const {
        return {move.x + cosine * p.x - sine * p.y, move.y + sine * p.x + cosine * p.y, move.z + p.z};
    }
    /// Returns the placement that applies `inner` first, then this one.
    Placement after(const Placement& inner) const {
        return {(*this)(inner.move), cosine * inner.cosine - sine * inner.sine,
                sine * inner.cosine + cosine * inner.sine};
    }
};

/// Which faces of a solid exist.
struct SolidFaces {
    bool bottom, top;
    unsigned sides;  ///< One bit per side; for a box: 0 front (-y), 1 right, 2 back, 3 left.
};

/// Builds scene descriptions from rectangles, boxes and prisms. Corners with equal coordinates are one point.
class PolygonKit {
  public:
    using Colour = std::array<double, 3>;
    using Faces = SolidFaces;
    static constexpr Faces all{true, true, ~0u}, no_bottom{false, true, ~0u}, only_sides{false, false, ~0u};

    explicit PolygonKit(std::string name) { scene_.file = std::move(name) + ".obj"; }

    /// Adds a material, or redefines it if the name exists.
    void material(const std::string& name, const Colour& reflectance, const Colour& radiance = {0, 0, 0});
    void material(const std::string& name, double reflectance, double radiance = 0) {
        material(name, Colour{reflectance, reflectance, reflectance}, Colour{radiance, radiance, radiance});
    }

    void polygon(std::string_view group, std::string_view material, std::span<const Point> outline);
    void polygon(std::string_view group, std::string_view material, std::initializer_list<Point> outline) {
        polygon(group, material, std::span(outline.begin(), outline.size()));
    }
    /// Adds a polygon, reversed if necessary so that its front faces the point `seen`.
    void facing(const Point& seen, std::string_view group, std::string_view material, std::vector<Point> outline);
    void horizontal(std::string_view group, std::string_view material, double x0, double y0, double x1, double y1,
                    double z, bool up = true);
    /// Adds a solid between two matching outlines, both counter-clockwise seen from above.
    void prism(std::string_view group, std::string_view material, const std::vector<Point>& base,
               const std::vector<Point>& top, const Faces& faces = all);
    void box(std::string_view group, std::string_view material, const Point& lo, const Point& hi,
             const Faces& faces = all, const Placement& place = {});

    std::size_t size() const { return scene_.faces.size(); }
    SceneDescription take() { return std::move(scene_); }

  private:
    std::uint32_t point(Point p);

    SceneDescription scene_;
    std::unordered_multimap<std::uint64_t, std::uint32_t> points_;
    std::unordered_map<std::string, std::uint32_t> groups_, materials_;
};

}  // namespace exitance
