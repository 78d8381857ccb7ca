#include "exitance/scene/emission_profile.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

using Angle = EmissionProfile::Angle;

/// Reflects an angle from 0 to 360 degrees into the range 0 to m. Subtracts, since std::fmod takes longer.
double folded(double angle, double m) {
    while (angle >= 2 * m) angle -= 2 * m;
    return angle <= m ? angle : 2 * m - angle;
}

double angle_of(Angle kind, const Vec3& d) {
    const auto phi = [&] {
        const double angle = std::atan2(d.y, d.x) / degree;
        return angle < 0 ? angle + 360 : angle;
    };
    switch (kind) {
        case Angle::theta:
            return std::atan2(std::sqrt(d.x * d.x + d.y * d.y), -d.z) / degree;
        case Angle::phi:
            return phi();
        case Angle::phi2:
            return folded(phi(), 180);
        case Angle::phi4:
            return folded(phi(), 90);
        case Angle::b_vertical:
            return std::atan2(d.x, -d.z) / degree;
        case Angle::b_vertical2:
            return std::abs(std::atan2(d.x, -d.z)) / degree;
        case Angle::b_horizontal:
            return std::atan2(-d.y, -d.z) / degree;
        case Angle::b_horizontal2:
            return std::abs(std::atan2(-d.y, -d.z)) / degree;
    }
    return 0;
}

bool goes_round(Angle kind) {
    return kind == Angle::phi || kind == Angle::phi2 || kind == Angle::phi4;
}

/// Position of an angle between two entries of an axis; `inside` is false outside of the table's range.
struct Place {
    std::size_t first = 0;
    double t = 0;  ///< Interpolation weight of the entry after `first`.
    bool inside = true;
};

Place find(const EmissionProfile::Axis& axis, const Vec3& d) {
    const std::vector<double>& at = axis.at;
    if (at.size() == 1) return {};
    const double angle = angle_of(axis.angle, d) + axis.offset;
    const std::size_t last = at.size() - 1;
    if (angle <= at.front()) return {0, 0, goes_round(axis.angle) || angle >= at[0] - 0.5 * (at[1] - at[0])};
    if (angle >= at.back())
        return {last - 1, 1, goes_round(axis.angle) || angle <= at[last] + 0.5 * (at[last] - at[last - 1])};
    // Most tables have equal steps, so that the step is known without a search.
    auto next =
        1 +
        std::min(last - 1, static_cast<std::size_t>((angle - at[0]) / (at[last] - at[0]) * static_cast<double>(last)));
    if (!(at[next - 1] <= angle && angle < at[next]))
        next = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), angle) - at.begin());
    return {next - 1, (angle - at[next - 1]) / (at[next] - at[next - 1])};
}

/// If parabolas through the ends and the middle of every k steps reproduce the table to a thousandth, returns the
/// narrowest of these intervals, degrees; else 0.
double parabolic_width(const std::vector<double>& at, const double* values, std::size_t stride, std::size_t k,
                       double least) {
    constexpr double negligible = 1e-3;
    double narrowest = 180;
    for (std::size_t first = 0; first + k < at.size(); first += std::max<std::size_t>(1, k / 2)) {
        const std::size_t last = first + k, middle = first + k / 2;
        const auto y = [&](std::size_t i) { return values[i * stride]; };
        double largest = least;
        for (std::size_t i = first; i <= last; ++i) largest = std::max(largest, y(i));
        const double a = at[first], b = at[middle], c = at[last];
        for (std::size_t i = first; i < last; ++i)
            for (const double x : {at[i], 0.5 * (at[i] + at[i + 1])}) {
                const double parabola = y(first) * (x - b) * (x - c) / ((a - b) * (a - c)) +
                                        y(middle) * (x - a) * (x - c) / ((b - a) * (b - c)) +
                                        y(last) * (x - a) * (x - b) / ((c - a) * (c - b));
                const double table = x == at[i] ? y(i) : 0.5 * (y(i) + y(i + 1));
                if (std::abs(parabola - table) > negligible * largest) return 0;
            }
        narrowest = std::min(narrowest, c - a);
    }
    return narrowest;
}

}  // namespace

double EmissionProfile::value(const Vec3& d) const {
    const Place i = find(axes[0], d);
    if (!i.inside) return 0;
    const Place k = find(axes[1], d);
    if (!k.inside) return 0;
    const std::size_t columns = axes[1].at.size();
    const auto row = [&](std::size_t r) {
        const double* v = &values[r * columns + k.first];
        return k.t > 0 ? v[0] + k.t * (v[1] - v[0]) : v[0];
    };
    const double here = row(i.first);
    return i.t > 0 ? here + i.t * (row(i.first + 1) - here) : here;
}

double EmissionProfile::radiance(const Vec3& d, double cosine) const {
    constexpr double grazing = 1e-9;
    const double v = value(d);
    switch (body) {
        case Body::none:
            return v;
        case Body::flat:
            return v / std::max(cosine, grazing);
        case Body::box:
            return v / (std::abs(d.x) * size.y * size.z + std::abs(d.y) * size.x * size.z +
                        std::abs(d.z) * size.x * size.y);
        case Body::cylinder:
            return v / (size.x * size.y * std::sqrt(std::max(0.0, 1 - d.z * d.z)) +
                        0.25 * pi * size.x * size.x * std::abs(d.z));
    }
    return v;
}

void EmissionProfile::find_smooth_width() {
    // A jump within a shorter step is an edge of the light, which no quadrature rule resolves.
    constexpr double widest = 30, jump = 1e-3;
    double width = widest;
    double sum = 0;
    for (const double v : values) sum += v;
    const double least = 0.05 * sum / static_cast<double>(values.size());
    const std::size_t rows = axes[0].at.size(), columns = axes[1].at.size();
    const auto add_axis = [&](const Axis& axis, std::size_t lines, std::size_t stride, std::size_t step) {
        double finest = widest;
        for (std::size_t i = 1; i < axis.at.size(); ++i)
            if (const double step = axis.at[i] - axis.at[i - 1]; step > jump) finest = std::min(finest, step);
        double found = axis.at.size() > 1 ? finest : widest;
        for (std::size_t k = 2; k < axis.at.size() && found < widest; k *= 2) {
            double narrowest = widest;
            for (std::size_t line = 0; line < lines; ++line)
                narrowest = std::min(narrowest, parabolic_width(axis.at, &values[line * stride], step, k, least));
            if (narrowest <= 0) break;
            found = std::max(found, narrowest);
        }
        width = std::min(width, found);
    };
    add_axis(axes[0], columns, 1, columns);
    add_axis(axes[1], rows, columns, 1);
    smooth_width = width * degree;
}

bool EmissionProfile::is_sane() const {
    constexpr double brightest = 1e30;
    for (const Axis& axis : axes) {
        if (axis.at.empty() || static_cast<int>(axis.angle) >= angle_kinds || !(std::abs(axis.offset) <= 360))
            return false;
        for (std::size_t i = 0; i < axis.at.size(); ++i)
            if (!(std::abs(axis.at[i]) <= 720) || (i > 0 && !(axis.at[i] > axis.at[i - 1]))) return false;
    }
    const auto is_length = [](double v) { return v >= 0 && v <= 1e6; };
    const bool has_size = is_length(size.x) && is_length(size.y) && is_length(size.z);
    const bool has_area = body == Body::box ? size.x * size.y > 0 && size.y * size.z > 0 : size.x > 0;
    return static_cast<int>(body) < bodies && has_size && has_area &&
           values.size() == axes[0].at.size() * axes[1].at.size() &&
           std::all_of(values.begin(), values.end(), [](double v) { return v >= 0 && v <= brightest; });
}

bool DirectedEmission::is_sane() const {
    constexpr double slack = 1e-6;
    const auto is_unit = [](const Vec3& v) { return std::abs(norm(v) - 1) < slack; };
    return is_unit(x) && is_unit(y) && is_unit(z) && std::abs(dot(x, y)) < slack && std::abs(dot(y, z)) < slack &&
           std::abs(dot(z, x)) < slack && scale >= 0 && scale <= 1e30;
}

double exitance_of(const EmissionProfile& profile, const Normal& n) {
    // Two-point Gauss rule on every step of a grid about the face's normal. Exact if the table's steps are the grid's,
    // as for lamps that shine straight down or up.
    constexpr int min_steps = 90;
    constexpr std::array gauss{0.5 - 0.28867513459481287, 0.5 + 0.28867513459481287};
    const bool is_upright = std::abs(n.z) > 1 - 1e-9;
    std::vector<double> steps;
    for (int i = 0; i <= min_steps; ++i) steps.push_back(i * 90.0 / min_steps);
    for (const EmissionProfile::Axis& axis : profile.axes)
        if (is_upright && axis.angle == Angle::theta)
            for (const double at : axis.at) steps.push_back(n.z < 0 ? at - axis.offset : 180 - at + axis.offset);
    std::erase_if(steps, [](double a) { return a < 0 || a > 90; });
    std::sort(steps.begin(), steps.end());
    const bool is_round = is_upright && profile.body != EmissionProfile::Body::box &&
                          profile.axes[0].angle == Angle::theta && profile.axes[1].at.size() == 1;
    const int around = is_round ? 1 : 96;
    const Frame frame(n);
    double sum = 0;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
        const double width = (steps[i + 1] - steps[i]) * degree;
        if (!(width > 1e-12)) continue;
        for (const double s : gauss) {
            const double theta = steps[i] * degree + s * width, sine = std::sin(theta), cosine = std::cos(theta);
            double ring = 0;
            for (int k = 0; k < around; ++k)
                for (const double t : gauss) {
                    const double phi = 2 * pi * (k + t) / around;
                    ring +=
                        profile.radiance(frame.to_world(sine * std::cos(phi), sine * std::sin(phi), cosine), cosine);
                }
            sum += 0.5 * width * sine * cosine * ring * pi / around;
        }
    }
    return sum;
}

}  // namespace exitance
