#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exitance/base/processor.hpp"
#include "exitance/base/vec.hpp"

namespace exitance {

/// Convex quads stored one array a coordinate, for evaluation several at a time. A triangle repeats its last corner.
class QuadBatch {
  public:
    void clear();
    void reserve(std::size_t count);
    /// Corners counter-clockwise seen from the front, metres.
    void add(const std::array<Point, 4>& corners);
    /// The same, where a ball that holds the quad is known: its middle and radius, metres.
    void add(const std::array<Point, 4>& corners, const Point& middle, double radius);
    std::size_t size() const { return radius_.size(); }
    std::array<Point, 4> corners(std::size_t k) const;

  private:
    friend void point_to_quads(const Point&, const Normal&, const QuadBatch&, std::span<double>, Processor);
    /// Where each coordinate begins: corners, middle, radius.
    std::array<const double*, 16> columns() const;

    std::array<std::vector<double>, 12> corner_;  ///< x, y, z of corner 0, then of corner 1, ...
    std::array<std::vector<double>, 3> middle_;
    std::vector<double> radius_;  ///< Of a ball about the middle, metres.
};

/// Form factors from a point to each quad of a batch, nothing in between: out[k] as point_to_polygon gives it.
///
/// Quads that look smaller than 0.006 take 7 points of the kernel (degree 5), others Lambert's contour sum with a
/// polynomial arc tangent; quads cut by the horizon are left to point_to_polygon. What a quad is given depends on
/// neither its place nor its neighbours. Relative error 1e-12, on grazing views as many digits fewer as the height over
/// the horizon has lost. About 8 ns a quad with AVX-512, 10 a small one, 12 and 13 without; more where groups of quads
/// are of several kinds, lie across the horizon, or have edges that look longer than 45 degrees.
/// x  point, metres      n  its unit normal      out  size() entries, in [0, 1]
void point_to_quads(const Point& x, const Normal& n, const QuadBatch& quads, std::span<double> out,
                    Processor processor = Processor::fastest);

/// Points with a normal each, one array a coordinate; groups of eight are filled with copies of the last one.
class ReceiverBatch {
  public:
    void clear() { count_ = 0; }
    void add(const Point& x, const Normal& n);
    std::size_t size() const { return count_; }

  private:
    friend void points_to_quad(const ReceiverBatch&, const std::array<Point, 4>&, std::span<double>, Processor);
    std::size_t count_ = 0;
    std::array<std::vector<double>, 6> column_;  ///< x, y, z of the points, then of their normals.
};

/// The other way about: out[k] is the form factor from receiver k to one quad, with the same rules and accuracy.
void points_to_quad(const ReceiverBatch& receivers, const std::array<Point, 4>& quad, std::span<double> out,
                    Processor processor = Processor::fastest);

/// Terms of Lambert's contour sum, gathered from any number of edges of any number of polygons.
class EdgeTerms {
  public:
    void clear() { count_ = 0; }
    /// Adds the edge from a to b (relative to the point x), times `weight`.
    void add(const Normal& n, const Vec3& a, const Vec3& b, double weight) {
        const Vec3 c = cross(a, b - a);
        if (count_ == squared_sine_.size()) grow();
        squared_sine_[count_] = dot(c, c);
        cosine_[count_] = dot(a, b);
        share_[count_++] = weight * dot(n, c);
    }
    /// Sum of weight times the edges' shares of the form factor, -1/(2 pi) angle(a, b) n . (a x b) / |a x b|. The edges
    /// of the part of a polygon above the horizon, counter-clockwise seen from its front, make point_to_polygon.
    double sum();

  private:
    void grow();
    std::size_t count_ = 0;
    std::vector<double> squared_sine_, cosine_, share_;
};

}  // namespace exitance
