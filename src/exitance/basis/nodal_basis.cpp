#include "exitance/basis/nodal_basis.hpp"

#include "exitance/basis/small_system.hpp"

namespace exitance {
namespace {

const Patch reference_square{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Patch::Shape::parallelogram};
const Patch reference_triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, Patch::Shape::triangle};

const Patch& reference(Patch::Shape shape) {
    return shape == Patch::Shape::triangle ? reference_triangle : reference_square;
}

}  // namespace

NodalBasis::NodalBasis(HierarchyBasis kind)
    : kind_(kind),
      order_(kind == HierarchyBasis::haar                                                ? 1
             : kind == HierarchyBasis::flatlet2 || kind == HierarchyBasis::multiwavelet2 ? 2
                                                                                         : 3),
      flat_(kind == HierarchyBasis::haar || kind == HierarchyBasis::flatlet2 || kind == HierarchyBasis::flatlet3),
      square_(make(Shape::parallelogram)),
      triangle_(make(Shape::triangle)) {}

std::size_t NodalBasis::monomial_count(Shape shape) const {
    const auto M = static_cast<std::size_t>(order_);
    return shape == Shape::triangle ? M * (M + 1) / 2 : M * M;
}

void NodalBasis::monomials(Shape shape, Vec2 uv, std::span<double> out) const {
    // Powers of the distance from the shape's centre: the equations lose fewer digits than with powers of uv.
    const double middle = shape == Shape::triangle ? 1.0 / 3 : 0.5;
    const double s = uv.x - middle, t = uv.y - middle;
    std::size_t k = 0;
    double sj = 1;
    for (int i = 0; i < order_; ++i, sj *= s) {
        double ti = sj;
        for (int j = 0; j < (shape == Shape::triangle ? order_ - i : order_); ++j, ti *= t) out[k++] = ti;
    }
}

/// Splits a patch into M x M equal parts; a row of a triangle alternates upright and inverted triangles.
std::vector<Patch> NodalBasis::boxes(const Patch& p) const {
    const Vec3 a = p.a / order_, b = p.b / order_;
    std::vector<Patch> out;
    for (int j = 0; j < order_; ++j) {
        for (int i = 0; i < (p.is_triangle() ? order_ - j : order_); ++i) {
            const Point o = p.origin + i * a + j * b;
            out.push_back({o, a, b, p.shape});
            if (p.is_triangle() && i + j + 1 < order_) out.push_back({o + a + b, -a, -b, p.shape});
        }
    }
    return out;
}

std::vector<double> NodalBasis::functionals(Shape shape, std::span<const PlanarNode> nodes, const Patch& piece) const {
    const std::size_t n = count(), m = monomial_count(shape);
    const auto in_parent = [](const Point& p) { return Vec2{p.x, p.y}; };
    std::vector<double> out(n * m, 0.0), term(m);
    const std::vector<Patch> parts = flat_ ? boxes(piece) : std::vector<Patch>();
    for (std::size_t k = 0; k < n; ++k) {
        const auto row = std::span(out).subspan(k * m, m);
        if (nodes[k].weight == 0) continue;
        if (!flat_) {
            monomials(shape, in_parent(piece.at(nodes[k].at)), row);
            continue;
        }
        for (const PlanarNode& node : parts[k].is_triangle() ? triangle_rule(4) : square_rule(3)) {
            monomials(shape, in_parent(parts[k].at(node.at)), term);
            for (std::size_t i = 0; i < m; ++i) row[i] += node.weight * term[i];
        }
    }
    return out;
}

NodalBasis::OfShape NodalBasis::make(Shape shape) const {
    OfShape out;
    const bool triangle = shape == Shape::triangle;
    const std::size_t n = count(), m = monomial_count(shape);
    if (flat_) {
        for (const Patch& box : boxes(reference(shape))) {
            const Point c = box.centre();
            out.nodes.push_back({{c.x, c.y}, 1.0 / static_cast<double>(n)});
        }
    } else {
        const auto rule = triangle ? triangle_rule(2 * (order_ - 1)) : square_rule(order_);
        out.nodes.assign(rule.begin(), rule.end());
        out.nodes.resize(n, {{1.0 / 3, 1.0 / 3}, 0});
    }
    // Weighted least squares for the monomial coefficients c: (V^T W V) c = V^T W coefficients.
    const std::vector<double> V = functionals(shape, out.nodes, reference(shape));
    std::vector<double> normal(m * m, 0.0);
    out.fit.assign(m * n, 0.0);
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t i = 0; i < m; ++i) {
            for (std::size_t j = 0; j < m; ++j) normal[i * m + j] += out.nodes[k].weight * V[k * m + i] * V[k * m + j];
            out.fit[i * n + k] = out.nodes[k].weight * V[k * m + i];
        }
    }
    solve_in_place(normal, out.fit, m, n);
    for (const Cut way : {Cut::u, Cut::v, Cut::both}) {
        if (triangle && way != Cut::both) continue;
        const std::vector<Patch> pieces = cut(reference(shape), way);
        for (std::size_t c = 0; c < pieces.size(); ++c) {
            const std::vector<double> child = functionals(shape, out.nodes, pieces[c]);
            std::vector<double>& push = out.push[static_cast<std::size_t>(way) - 1][c];
            std::vector<double>& pull = out.pull[static_cast<std::size_t>(way) - 1][c];
            push.assign(n * n, 0.0);
            pull.assign(n * n, 0.0);
            const double share = 1 / static_cast<double>(pieces.size());
            for (std::size_t k = 0; k < n; ++k) {
                for (std::size_t j = 0; j < n; ++j) {
                    for (std::size_t i = 0; i < m; ++i) push[k * n + j] += child[k * m + i] * out.fit[i * n + j];
                    if (!flat_ && out.nodes[j].weight > 0)
                        pull[j * n + k] = share * out.nodes[k].weight / out.nodes[j].weight * push[k * n + j];
                }
                const Point middle = pieces[c].at(out.nodes[k].at);
                if (flat_) pull[box_at(shape, {middle.x, middle.y}) * n + k] = share;
            }
        }
    }
    return out;
}

void NodalBasis::from_monomials(Shape shape, std::span<const double> values, std::span<double> out) const {
    const std::size_t n = count(), m = monomial_count(shape);
    const double* fit = of(shape).fit.data();
    std::array<double, 9> sum{};  // the compiler can keep this array in registers, unlike `out`, which may alias
    for (std::size_t i = 0; i < m; ++i, fit += n)
        for (std::size_t k = 0; k < n; ++k) sum[k] += values[i] * fit[k];
    std::copy_n(sum.begin(), n, out.begin());
}

void NodalBasis::interpolate(Shape shape, Vec2 uv, std::span<double> factors) const {
    std::array<double, 9> value{};
    monomials(shape, uv, value);
    from_monomials(shape, value, factors);
}

std::span<const double> NodalBasis::push(Shape shape, Cut way, std::size_t child) const {
    return of(shape).push[static_cast<std::size_t>(way) - 1][child];
}

std::span<const double> NodalBasis::pull(Shape shape, Cut way, std::size_t child) const {
    return of(shape).pull[static_cast<std::size_t>(way) - 1][child];
}

void NodalBasis::push_to(Shape parent, std::span<const Vec2> places, std::span<double> factors) const {
    for (std::size_t k = 0; k < places.size(); ++k)
        interpolate(parent, places[k], factors.subspan(k * count(), count()));
}

std::size_t NodalBasis::box_at(Shape shape, Vec2 uv) const {
    uv = into_shape(uv, shape);
    const auto index = [&](double t) { return std::min(order_ - 1, static_cast<int>(t * order_)); };
    const int i = index(uv.x), j = index(uv.y);
    if (shape == Shape::parallelogram) return static_cast<std::size_t>(j * order_ + i);
    // Row j begins after rows of 2 M - 1, 2 M - 3, ... triangles; upright and inverted ones alternate in it.
    const double s = uv.x * order_ - i, t = uv.y * order_ - j;
    const int turned = s + t > 1 && i + j + 1 < order_ ? 1 : 0;
    return static_cast<std::size_t>(j * (2 * order_ - j) + 2 * i + turned);
}

}  // namespace exitance
