#include "exitance/io/photometry/photometry.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

/// Position of an angle between two table entries; `inside` is false beyond both ends.
struct AnglePlace {
    std::size_t first = 0;
    double t = 0;
    bool inside = true;
};

AnglePlace find(const std::vector<double>& at, double angle) {
    constexpr double rounding = 1e-9;  // degrees
    if (at.size() == 1) return {};
    if (angle < at.front() - rounding || angle > at.back() + rounding) return {0, 0, false};
    const auto next = std::upper_bound(at.begin() + 1, at.end() - 1, angle) - at.begin();
    const auto i = static_cast<std::size_t>(next) - 1;
    return {i, std::clamp((angle - at[i]) / (at[i + 1] - at[i]), 0.0, 1.0)};
}

/// Integral of f(t) sin t over [t0, t1], radians, where f is linear from f0 to f1.
double segment(double t0, double t1, double f0, double f1) {
    const double b = (f1 - f0) / (t1 - t0), a = f0 - b * t0;
    const auto primitive = [&](double t) { return -a * std::cos(t) + b * (std::sin(t) - t * std::cos(t)); };
    // Over a short step, the difference of primitives would cancel; the midpoint rule is as accurate.
    if (t1 - t0 < 1e-4) return 0.5 * (f0 + f1) * std::sin(0.5 * (t0 + t1)) * (t1 - t0);
    return primitive(t1) - primitive(t0);
}

}  // namespace

const char* name_of(Opening::Shape shape) {
    switch (shape) {
        case Opening::Shape::point:
            return "point";
        case Opening::Shape::rectangle:
            return "rectangle";
        case Opening::Shape::ellipse:
            return "ellipse";
        case Opening::Shape::box:
            return "box";
        case Opening::Shape::cylinder_x:
            return "cylinder along x";
        case Opening::Shape::cylinder_y:
            return "cylinder along y";
        case Opening::Shape::cylinder_z:
            return "upright cylinder";
        case Opening::Shape::ellipsoid:
            return "ellipsoid";
    }
    return "";
}

double Photometry::intensity(const Vec3& d) const {
    const Vec3 e{dot(axis_x, d), dot(axis_y, d), dot(axis_z, d)};
    const double across = std::sqrt(e.x * e.x + e.y * e.y);
    const AnglePlace t = find(theta, std::atan2(across, -e.z) / degree);
    if (!t.inside) return 0;
    double angle = phi.size() > 1 ? std::atan2(e.y, e.x) / degree : 0;
    if (angle < 0) angle += 360;
    const AnglePlace p = find(phi, angle);
    if (!p.inside) return 0;
    const auto ring = [&](std::size_t plane) {
        if (theta.size() == 1) return at(plane, 0);
        return at(plane, t.first) + t.t * (at(plane, t.first + 1) - at(plane, t.first));
    };
    const double here = ring(p.first);
    return p.t > 0 ? here + p.t * (ring(p.first + 1) - here) : here;
}

double Photometry::largest() const {
    return candela.empty() ? 0 : *std::max_element(candela.begin(), candela.end());
}

double Photometry::flux(double from, double to) const {
    const auto ring = [&](std::size_t p) {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < theta.size(); ++i) {
            const double a = std::max(theta[i], from), b = std::min(theta[i + 1], to);
            if (!(b > a)) continue;
            const auto value = [&](double t) {
                return at(p, i) + (t - theta[i]) / (theta[i + 1] - theta[i]) * (at(p, i + 1) - at(p, i));
            };
            sum += segment(a * degree, b * degree, value(a), value(b));
        }
        return sum;
    };
    if (phi.size() == 1) return 2 * pi * ring(0);
    double sum = 0, before = ring(0);
    for (std::size_t p = 1; p < phi.size(); ++p) {
        const double here = ring(p);
        sum += 0.5 * (before + here) * (phi[p] - phi[p - 1]) * degree;
        before = here;
    }
    return sum;
}

BeamSpread beam_spread(const Photometry& p, const Vec3& towards, double share) {
    constexpr int steps = 900;  // steps of 0.1 degrees
    const auto at = [&](const Normal& axis, double angle) {
        return p.intensity(std::cos(angle * degree) * axis + std::sin(angle * degree) * towards);
    };
    const auto largest = [&](const Normal& axis) {
        double most = 0;
        for (int i = -steps; i <= steps; ++i) most = std::max(most, at(axis, 90.0 * i / steps));
        return most;
    };
    Normal axis{0, 0, -1};
    double most = largest(axis);
    if (!(most > 0)) axis = {0, 0, 1}, most = largest(axis);
    if (!(most > 0)) return {};
    // Find the last direction of a side with that share, then bisect the next step.
    const auto side = [&](double sign) {
        const auto holds = [&](double angle) { return at(axis, sign * angle) >= share * most; };
        for (int i = steps; i >= 0; --i) {
            double inner = 90.0 * i / steps, outer = inner + 90.0 / steps;
            if (!holds(inner)) continue;
            if (i == steps) return inner;
            for (int k = 0; k < 30; ++k) {
                const double middle = 0.5 * (inner + outer);
                (holds(middle) ? inner : outer) = middle;
            }
            return inner;
        }
        return 0.0;
    };
    return {side(-1), side(1)};
}

void tell(Photometry& p, Finding::Kind kind, int line, std::string message, std::string hint) {
    p.findings.push_back({kind, p.file, line, std::move(message), std::move(hint)});
}

}  // namespace exitance
