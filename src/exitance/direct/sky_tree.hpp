#pragma once

#include <cstdint>
#include <vector>

#include "exitance/scene/sky/distant_light.hpp"

namespace exitance {

/// Binary tree over the directions of the domes of a distant light, to choose directions for rays in proportion to
/// radiance times the cosine at a receiver.
///
/// The leaves are cells of equal-area coordinates: the height z of a direction and its azimuth. A cell is halved across
/// its wider extent, the one first whose radiance varies most or that is widest, each weighted by its flux. For a
/// receiver's normal a cell weighs as much as its flux times its mean cosine above the horizon. A point of the unit
/// square is mapped to a direction by descending the tree: at every node one coordinate chooses the child and is
/// stretched to [0, 1) again, so that well distributed points give well distributed directions. Source: [Clarberg05].
class SkyTree {
  public:
    explicit SkyTree(const DistantLight& light);

    bool empty() const { return leaves_.empty(); }

    /// Weights of the nodes for one normal.
    struct Aim {
        Normal n;
        std::vector<double> weight;  ///< Weight of each node; empty until a normal is set.
        /// Irradiance of an unoccluded receiver by the cells' quadrature, W/m^2. Relative error 3e-4.
        Spectrum open;
    };
    /// Computes the weights for a normal. O(cells), about 5 us; returns at once if `aim` is of that normal.
    void aim(const Normal& n, Aim& aim) const;

    struct Direction {
        Vec3 w;              ///< Unit vector.
        double density = 0;  ///< Probability density per solid angle, 1/sr.
    };
    /// Returns the direction of the point (s, t) in [0, 1)^2. The weight of the root must not be 0.
    Direction direction(const Aim& aim, double s, double t) const;

  private:
    /// A range of z and of azimuth (turns); a leaf has no children.
    struct Node {
        double z0, z1, turn0, turn1;
        std::uint32_t first_child = 0;  ///< Index of the first of two consecutive children; 0 for a leaf.
        std::uint32_t leaf = 0;         ///< Index of the leaf.
        bool splits_z = false;
    };
    struct Leaf {
        Vec3 middle;        ///< Unit vector to the middle of the cell.
        double radius = 0;  ///< Largest angle between `middle` and a direction of the cell, radians.
        double flux = 0;    ///< Mean over bands of the integral of pi times the radiance, W/m^2 sr.
    };
    /// A sample point of the quadrature over cells.
    struct Sample {
        Vec3 w;
        Spectrum light;  ///< Radiance times solid angle, W/m^2.
    };
    void look_at(std::uint32_t node, const DistantLight& light, Leaf& leaf, double& priority) const;
    void make_leaves(const DistantLight& light);

    std::vector<Node> nodes_;
    std::vector<Leaf> leaves_;
    std::vector<Sample> samples_;
};

}  // namespace exitance
