#include "exitance/transport/hemicube_rows.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/trace.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {

Hemicube::Hemicube(unsigned cells) {
    const double h = 2.0 / cells;
    // Each face is spanned by two edges from a corner, counter-clockwise as seen from inside.
    const auto add_face = [&](const Vec3& corner, const Vec3& s, const Vec3& t, unsigned columns, unsigned rows) {
        for (unsigned j = 0; j < rows; ++j)
            for (unsigned i = 0; i < columns; ++i) {
                const Vec3 a = corner + (i * h) * s + (j * h) * t;
                const Vec3 cell[] = {a, a + h * s, a + h * s + h * t, a + h * t};
                direction.push_back(a + (0.5 * h) * (s + t));
                factor.push_back(point_to_polygon({}, {0, 0, 1}, cell));
            }
    };
    const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    add_face({-1, -1, 1}, y, x, cells, cells);
    add_face({1, -1, 0}, z, y, cells / 2, cells);
    add_face({-1, -1, 0}, y, z, cells, cells / 2);
    add_face({-1, 1, 0}, x, z, cells, cells / 2);
    add_face({-1, -1, 0}, z, x, cells / 2, cells);
}

Normal hemicube_axis(const Patch& patch, const Normal& n) {
    const Normal u = normalized(patch.a - dot(patch.a, n) * n), v = cross(n, u);
    const Vec3 edges[] = {patch.a, patch.b, patch.b - patch.a};
    double x = 0, y = 0, both = 0;  // sums of squares and products of the edges' coordinates in the plane
    for (std::size_t k = 0; k < (patch.is_triangle() ? 3u : 2u); ++k) {
        const double s = dot(edges[k], u), t = dot(edges[k], v);
        x += s * s, y += t * t, both += s * t;
    }
    // Below it, the patch has no principal axis: it is equally long in all directions. Derived from the rounding of
    // coordinates in files.
    constexpr double rounding = 1e-6;
    if (std::hypot(x - y, 2 * both) <= rounding * (x + y)) return u;
    const double angle = 0.5 * std::atan2(2 * both, x - y);
    return std::cos(angle) * u + std::sin(angle) * v;
}

namespace {

/// Makes the rows of one thread's elements, one at a time.
class RowMaker {
  public:
    RowMaker(const Stage& stage, const NumberedLeaves& leaves, const Hemicube& cube)
        : stage_(stage),
          tree_(leaves.tree),
          locator_(leaves.locator),
          cube_(cube),
          directions_(cube.direction.size()),
          hits_(cube.direction.size()),
          sum_(leaves.numbering.leaves.size(), 0.0) {}

    /// Calls add(leaf number, form factor) for every leaf visible from the centre of `e`, in ascending order.
    template <class Add>
    void make(ElementId e, const Add& add) {
        const Patch& patch = tree_.patch(e);
        const RegionId region = tree_.region(e);
        const Normal n = stage_.scene.regions()[region].plane.n, u = hemicube_axis(patch, n), v = cross(n, u);
        const Point x = patch.at(tree_.centre(e));
        for (std::size_t k = 0; k < directions_.size(); ++k) {
            const Vec3& d = cube_.direction[k];
            directions_[k] = d.x * u + d.y * v + d.z * n;
        }
        stage_.tracer.nearest(directions_, x, region, hits_, Mirrored::followed);
        queries_.clear(), cell_.clear(), seen_.clear();
        for (std::size_t k = 0; k < hits_.size(); ++k) {
            if (hits_[k].surface.is_none() || !hits_[k].front) continue;
            const RegionId hit = hits_[k].region;
            locator_.find_root(hit, place_of(stage_.scene, hits_[k], x, directions_[k]), queries_.emplace_back());
            cell_.push_back(k);
        }
        locator_.leaves().find(queries_);
        for (std::size_t i = 0; i < queries_.size(); ++i) {
            double& sum = sum_[queries_[i].leaf];
            if (sum == 0) seen_.push_back(queries_[i].leaf);
            sum += cube_.factor[cell_[i]];
        }
        std::sort(seen_.begin(), seen_.end());
        for (std::uint32_t leaf : seen_) add(leaf, std::exchange(sum_[leaf], 0.0));
    }

  private:
    const Stage& stage_;
    const ElementTree& tree_;
    const ElementLocator& locator_;
    const Hemicube& cube_;
    std::vector<Vec3> directions_;
    std::vector<RayHit> hits_;
    std::vector<LeafFinder::Query> queries_;
    std::vector<std::size_t> cell_;
    std::vector<double> sum_;  ///< Form factor of each leaf, by number; zero between rows.
    std::vector<std::uint32_t> seen_;
};

}  // namespace

HemicubeRows::HemicubeRows(const Stage& stage, const NumberedLeaves& leaves, unsigned cells) {
    const LeafNumbering& numbering = leaves.numbering;
    const Hemicube cube(cells);
    const std::size_t n = numbering.leaves.size();
    std::vector<std::vector<Entry>> rows(n);
    parallel_ranges(n, 16,
                    [&](std::size_t begin, std::size_t end) {
                        RowMaker maker(stage, leaves, cube);
                        for (std::size_t i = begin; i < end; ++i)
                            maker.make(numbering.leaves[i], [&](std::uint32_t leaf, double factor) {
                                rows[i].push_back({leaf, static_cast<float>(factor)});
                            });
                        note_touched("rays", (end - begin) * cube.factor.size());
                    },
                    {"hemicubes", [&](std::size_t i) { return leaves.tree.region(numbering.leaves[i]).value; }});
    rays_ = n * cube.factor.size();
    for (std::vector<Entry>& row : rows) {
        first_.push_back(entry_.size());
        entry_.insert(entry_.end(), row.begin(), row.end());
        row = {};
    }
    first_.push_back(entry_.size());
}

Spectrum HemicubeRows::gather_at(std::size_t receiver, std::span<const Spectrum> radiosity) const {
    Spectrum sum;
    for (std::size_t k = first_[receiver]; k < first_[receiver + 1]; ++k)
        sum += static_cast<double>(entry_[k].factor) * radiosity[entry_[k].source];
    return sum;
}

void HemicubeRows::gather(std::span<const Spectrum> radiosity, std::span<Spectrum> irradiance) const {
    parallel_for(size(), 64, [&](std::size_t i) { irradiance[i] = gather_at(i, radiosity); });
}

double HemicubeRows::form_factor(std::size_t receiver, std::size_t source) const {
    const auto begin = entry_.begin() + static_cast<std::ptrdiff_t>(first_[receiver]),
               end = entry_.begin() + static_cast<std::ptrdiff_t>(first_[receiver + 1]);
    const auto at = std::lower_bound(begin, end, source, [](const Entry& e, std::size_t s) { return e.source < s; });
    return at != end && at->source == source ? static_cast<double>(at->factor) : 0;
}

}  // namespace exitance
