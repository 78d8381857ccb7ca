#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/processor.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// Convex quads stored as one array per coordinate, for SIMD evaluation. A triangle repeats its last corner.
class QuadBatch {
  public:
    void clear();
    void reserve(std::size_t count);
    /// Adds a quad; corners counter-clockwise seen from the front, metres.
    void add(const std::array<Point, 4>& corners);
    /// Adds a quad with a known bounding ball: its centre and radius, metres.
    void add(const std::array<Point, 4>& corners, const Point& middle, double radius);
    std::size_t size() const { return radius_.size(); }
    std::array<Point, 4> corners(std::size_t k) const;

  private:
    friend void point_to_quads(const Point&, const Normal&, const QuadBatch&, std::span<double>, Processor);
    /// Returns the start of each coordinate array: corners, centre, radius.
    std::array<const double*, 16> columns() const;

    std::array<std::vector<double>, 12> corner_;  ///< x, y, z of corner 0, then of corner 1, ...
    std::array<std::vector<double>, 3> middle_;
    std::vector<double> radius_;  ///< Radius of the ball about the centre, metres.
};

/// Computes form factors from a point to each quad of a batch without occlusion: out[k] as point_to_polygon() returns
/// it.
///
/// Quads that subtend less than 0.006 use 7 quadrature points (degree 5); others use Lambert's contour sum with a
/// polynomial arc tangent. Quads cut by the horizon use point_to_polygon(). Results depend neither on the position of a
/// quad in the batch nor on its neighbours.
/// x    point, metres
/// n    its unit normal
/// out  size() entries, in [0, 1]
/// Relative error 1e-12; at grazing angles it grows as the height above the horizon loses digits. About 8 ns per quad
/// with AVX-512 and 10 ns per small one; 12 and 13 ns without. Slower for groups with quads of several kinds, across
/// the horizon, or with edges longer than 45 degrees.
void point_to_quads(const Point& x, const Normal& n, const QuadBatch& quads, std::span<double> out,
                    Processor processor = Processor::fastest);

/// Points with a normal each, stored as one array per coordinate. The last group of eight is filled with copies of the
/// last point.
class ReceiverBatch {
  public:
    void clear() { count_ = 0; }
    void add(const Point& x, const Normal& n);
    std::size_t size() const { return count_; }

  private:
    friend void points_to_quad(const ReceiverBatch&, const std::array<Point, 4>&, std::span<double>, Processor);
    std::size_t count_ = 0;
    /// Coordinates in columns: x, y, z of the points, then x, y, z of the normals.
    std::array<std::vector<double>, 6> column_;
};

/// Computes form factors from many points to one quad: out[k] is that of receiver k, with the same rules and accuracy.
void points_to_quad(const ReceiverBatch& receivers, const std::array<Point, 4>& quad, std::span<double> out,
                    Processor processor = Processor::fastest);

/// Terms of Lambert's contour sum, collected from edges of any number of polygons and summed together.
class EdgeTerms {
  public:
    void clear() { count_ = 0; }
    /// Adds the edge from a to b (relative to the point), multiplied by `weight`.
    void add(const Normal& n, const Vec3& a, const Vec3& b, double weight) {
        const Vec3 c = cross(a, b - a);
        if (count_ == squared_sine_.size()) grow();
        squared_sine_[count_] = dot(c, c);
        cosine_[count_] = dot(a, b);
        share_[count_++] = weight * dot(n, c);
    }
    /// Returns the sum of weight times the edges' contributions to the form factor, -1/(2 pi) angle(a, b) n . (a x b) /
    /// |a x b|. For the edges of the part of a polygon above the horizon, counter-clockwise seen from its front, this
    /// is point_to_polygon().
    double sum();

  private:
    void grow();
    std::size_t count_ = 0;
    std::vector<double> squared_sine_, cosine_, share_;
};

}  // namespace exitance
