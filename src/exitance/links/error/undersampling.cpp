#include "exitance/links/error/undersampling.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/polygon.hpp"
#include "exitance/calibration/numbers.hpp"

namespace exitance {
namespace {

/// The part of an element in front of a plane.
struct FrontPart {
    Plane plane;
    std::vector<Point> outline;
    Point middle;
    double area = 0, radius = 0;  ///< m^2, m; area 0: nothing is in front.

    double thickness() const { return area / (2 * radius); }  ///< Width of a long part, m.

    /// Moves a point towards the middle by at least this share of the way, and in front of the plane.
    Point drawn_in(const Point& x, double share) const {
        const double height = plane.signed_distance(middle), h = plane.signed_distance(x),
                     to_front = h < height ? (share * height - h) / (height - h) : 0;
        return x + std::clamp(to_front, share, 1.0) * (middle - x);
    }
};

FrontPart front_part(const LinkSites& sites, ElementId element, ElementId other) {
    FrontPart out;
    out.plane = {sites.normal(other), dot(sites.normal(other), sites.centre(other))};
    clip(sites.tree().outline(element), out.plane, out.outline);
    out.area = norm(area_vector(out.outline));
    if (out.area <= 0) return out;
    out.middle = centroid(out.outline);
    for (const Point& corner : out.outline) out.radius = std::max(out.radius, norm(corner - out.middle));
    return out;
}

/// Tests a transfer for errors at points other than the check points of its rule.
class Undersampling {
  public:
    Undersampling(OpenTransferRule& rule, const LinkSites& sites, const OpenTransfer& transfer, ElementId receiver,
                  const SourceLight& source, bool certainly_open)
        : rule_(rule),
          sites_(sites),
          transfer_(transfer),
          receiver_(receiver),
          source_(source),
          certainly_open_(certainly_open) {}

    double peak() const {
        const FrontPart receiver = front_part(sites_, receiver_, source_.element),
                        source = front_part(sites_, source_.element, receiver_);
        if (receiver.area <= 0 || source.area <= 0) return 0;
        const Patch receiver_frame = sites_.frame(receiver_), source_frame = sites_.frame(source_.element);
        const auto nearest = [](const Patch& patch, const FrontPart& part, const Point& x) {
            return part.drawn_in(patch.at(into_shape(patch.coordinates(x), patch.shape)), 0);
        };
        // Distances of points from borders, as shares of the source's thickness and of the receiver.
        constexpr double in_front = 0.5;
        const double thickness = source.thickness();
        const Point before = nearest(receiver_frame, receiver, source.middle + in_front * thickness * source_.normal);
        Point close = nearest(receiver_frame, receiver, source.middle);
        for (int i = 0; i < 4; ++i)  // alternating projections converge to the closest point
            close = nearest(receiver_frame, receiver, nearest(source_frame, source, close));
        const double depth = norm(receiver.middle - close);
        const double off = std::min(calibrated::peak_largest_border, in_front * thickness / std::max(depth, thickness));
        const auto error = [&](const Point& x) {
            return error_at(x, norm(nearest(source_frame, source, x) - x), source);
        };
        return std::max(error(receiver.drawn_in(before, calibrated::peak_border)),
                        error(receiver.drawn_in(close, off)));
    }

    /// Returns the error due to a steep fall of the light. `allowed`: smaller errors are not computed, W/m^2.
    double fall(double allowed) const {
        // A fall counts if the polynomial is at least `min_factor` times the exact value and the error is at least
        // half of the brightest point; it covers about `fall_area` of the receiver.
        const double area_share = calibrated::fall_area;
        constexpr double min_factor = 4, min_share = 0.5;
        if (source_.nodes == 1 || std::sqrt(area_share) * transfer_.brightest <= allowed) return 0;
        double most = 0;
        for (const Point& corner : sites_.tree().outline(receiver_)) {
            const Point x = corner + calibrated::fall_border * (sites_.centre(receiver_) - corner);
            const double exact = light_at(x), polynomial = rule_.interpolated(transfer_, receiver_, x),
                         error = std::abs(polynomial - exact);
            if (std::abs(polynomial) > min_factor * std::abs(exact) && error > min_share * transfer_.brightest)
                most = std::max(most, error);
        }
        return std::sqrt(area_share) * most;
    }

  private:
    double light_at(const Point& x) const {
        return source_.received(rule_.row(transfer_, source_, x, sites_.normal(receiver_)));
    }

    /// RMS error over the receiver from a peak at point x, `gap` metres from the source. 0 if x is not brighter than
    /// the check points by a factor.
    double error_at(const Point& x, double gap, const FrontPart& source) const {
        const double min_factor = source_.nodes == 1 ? 8
                                  : certainly_open_  ? 4
                                                     : calibrated::peak_factor_hidden,
                     least = min_factor * transfer_.brightest;
        const double F = rule_.form_factor(x, sites_.normal(receiver_), source.outline),
                     residual = F * source_.roughness;
        if (F * std::abs(source_.mean) + residual < least) return 0;
        const double exact = light_at(x);
        if (std::max(std::abs(exact), residual) < least) return 0;
        const double error = std::max(std::abs(exact - rule_.interpolated(transfer_, receiver_, x)), residual);
        const double peak_area = (2 * source.radius + gap) * (source.thickness() + gap);
        return error * std::sqrt(std::min(1.0, peak_area / sites_.tree().area(receiver_)));
    }

    OpenTransferRule& rule_;
    const LinkSites& sites_;
    const OpenTransfer& transfer_;
    ElementId receiver_;
    const SourceLight& source_;
    bool certainly_open_;
};

}  // namespace

double undersampling_error(OpenTransferRule& rule, const LinkSites& sites, const OpenTransfer& transfer,
                           ElementId receiver, const SourceLight& source, bool certainly_open, double allowed) {
    if (!transfer.near) return 0;
    const Undersampling missed(rule, sites, transfer, receiver, source, certainly_open);
    return std::max(missed.peak(), missed.fall(allowed));
}

}  // namespace exitance
