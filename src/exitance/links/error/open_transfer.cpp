#include "exitance/links/error/open_transfer.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/calibration/numbers.hpp"
#include "exitance/form_factors/point_to_polygon.hpp"

namespace exitance {
namespace {

/// Scale from a rule's result to the exact one. Beyond these bounds the horizon cuts the source.
double scale_to(double exact, double rule) {
    constexpr double min_scale = 0.5, max_scale = 2;
    return rule > 0 ? std::clamp(exact / rule, min_scale, max_scale) : 1;
}

}  // namespace

double OpenTransfer::largest_light(std::size_t nodes) const {
    double most = 0;
    for (std::size_t k = 0; k < nodes; ++k) most = std::max(most, std::abs(light[k]));
    return most;
}

double OpenTransferRule::ratio(ElementId receiver, ElementId source) const {
    constexpr double min_gap = 1e-3;  // share of the source's size: avoids rounding (derived from rounding)
    const double radius = sites_.radius(source);
    const double gap = norm(sites_.centre(source) - sites_.centre(receiver)) - sites_.radius(receiver);
    return radius / std::max(gap, min_gap * radius);
}

double OpenTransferRule::form_factor(const Point& x, const Normal& n, std::span<const Point> outline) {
    ++form_factors_;
    return point_to_polygon(x, n, outline);
}

NodeRow OpenTransferRule::row(const OpenTransfer& transfer, const SourceLight& source, const Point& x,
                              const Normal& n) {
    if (!transfer.near) return source.kernel_row(x, n);
    NodeRow out{};
    ++form_factors_;
    near_row_(x, n, out.data());
    return out;
}

/// The row for a receiver with one value: the mean over its Gauss points, whose light is stored in `light`. The centre
/// alone would miss peaks at edges where surfaces meet.
NodeRow OpenTransferRule::mean_row(const OpenTransfer& transfer, const SourceLight& source, const Patch& receiver,
                                   const Normal& n, Departure& light) {
    const std::span<const Vec2> at = checks_.at(receiver.shape);
    NodeRow out{};
    for (std::size_t i = 0; i < at.size(); ++i) {
        const NodeRow here = row(transfer, source, receiver.at(at[i]), n);
        light[i] = source.received(here);
        out[0] += here[0] / static_cast<double>(at.size());
    }
    return out;
}

/// Computes rows and light at the nodes; for constants also the light at the check points, stored in `departure`.
/// Returns the mean form factor over the receiver.
double OpenTransferRule::set_rows(OpenTransfer& transfer, ElementId receiver, const SourceLight& source) {
    const Normal& n = sites_.normal(receiver);
    const Patch frame = sites_.frame(receiver);
    double mean = 0;
    transfer.departure.fill(0);
    for (std::size_t k = 0; k < nodes_; ++k) {
        NodeRow& row_k = transfer.rows[k];
        row_k = nodes_ == 1 ? mean_row(transfer, source, frame, n, transfer.departure)
                            : row(transfer, source, sites_.receiving_node(receiver, k), n);
        transfer.light[k] = source.received(row_k);
        for (std::size_t l = 0; l < nodes_; ++l) mean += sites_.weight(receiver, k) * row_k[l];
    }
    return mean;
}

/// Largest error at a node of the recomputed kernel, scaled to the mean of the near rows, W/m^2. It is small for small
/// or dim sources even if they are near.
double OpenTransferRule::error_of_kernel(OpenTransfer& transfer, ElementId receiver, const SourceLight& source) const {
    if (nodes_ == 1) return 0;
    // Share of their sizes: single precision loses nodes that are nearer (derived from rounding).
    constexpr double least = 1e-3;
    const double nearest = least * (sites_.radius(receiver) + sites_.radius(source.element));
    std::array<NodeRow, 9> kernel;
    double exact = 0, rule = 0;
    for (std::size_t k = 0; k < nodes_; ++k) {
        const Point x = sites_.receiving_node(receiver, k);
        kernel[k] = source.kernel_row(x, sites_.normal(receiver));
        for (std::size_t l = 0; l < nodes_; ++l) {
            exact += sites_.weight(receiver, k) * transfer.rows[k][l],
                rule += sites_.weight(receiver, k) * kernel[k][l];
            if (squared_norm(source.node[l] - x) < nearest * nearest) return HUGE_VAL;
        }
    }
    const double scale = transfer.kernel_scale = scale_to(exact, rule);
    constexpr double rounding = 1e-6;  // derived from rounding
    // even small errors of one sign accumulate over links
    if (std::abs(scale * rule - exact) > rounding * exact) return HUGE_VAL;
    double most = 0;
    for (std::size_t k = 0; k < nodes_; ++k)
        most = std::max(most, std::abs(scale * source.received(kernel[k]) - transfer.light[k]));
    return most;
}

OpenTransfer OpenTransferRule::send(ElementId receiver, const SourceLight& source, double allowed) {
    const bool by_error = tolerance_.oracle == LinkOracle::transport;
    const int M = sites_.basis().order();
    OpenTransfer out;
    out.ratio = ratio(receiver, source.element);
    const double relative_error = tolerance_.systematic * calibrated::kernel_rule_error * std::pow(out.ratio, 2 * M);
    double mean_form_factor = 0, kernel_error = 0;
    if (out.ratio <= calibrated::nearest_integrated_ratio) {
        mean_form_factor = set_rows(out, receiver, source);
        // Strength says nothing about the accuracy of the rule, so those oracles always use the accurate one.
        const bool needs_near_rows =
            !by_error || out.largest_light(nodes_) * relative_error > calibrated::negligible_link_share * allowed;
        out.near = out.ratio > calibrated::farthest_integrated_ratio && needs_near_rows;
    }
    if (out.ratio > calibrated::nearest_integrated_ratio || out.near) {
        out.near = true;
        near_row_.set_source(source.element);
        mean_form_factor = set_rows(out, receiver, source);
        kernel_error = tolerance_.systematic * error_of_kernel(out, receiver, source);
        const bool is_good_enough =
            by_error && kernel_error <= calibrated::negligible_link_share * allowed && allowed < HUGE_VAL;
        out.has_block = nodes_ > 1 && !is_good_enough;
        if (out.has_block) kernel_error = 0;
    }
    const double most = out.largest_light(nodes_);
    out.brightest = most;
    const Patch frame = sites_.frame(receiver);
    const std::span<const Vec2> at = checks_.at(frame.shape);
    for (std::size_t i = 0; i < at.size(); ++i) {
        double& departure = out.departure[i];
        if (nodes_ > 1) departure = source.received(row(out, source, frame.at(at[i]), sites_.normal(receiver)));
        out.brightest = std::max(out.brightest, std::abs(departure));
        const std::span<const double> factors = checks_.factors(frame.shape, i);
        for (std::size_t k = 0; k < nodes_; ++k) departure -= factors[k] * out.light[k];
    }
    const double residual =
        tolerance_.residual_weight * std::min(1.0, std::pow(out.ratio, M)) * mean_form_factor * source.roughness;
    out.rule_error = (out.near ? kernel_error : most * relative_error) + tolerance_.systematic * residual;
    return out;
}

EvenTransfer OpenTransferRule::send_evenly(ElementId receiver, const SourceLight& source, double b, double allowed) {
    const Normal& n = sites_.normal(receiver);
    const Patch frame = sites_.frame(receiver);
    const Point middle = sites_.centre(source.element);
    const double ratio = this->ratio(receiver, source.element);
    const double relative_error = tolerance_.systematic * calibrated::kernel_rule_error * ratio * ratio;
    EvenTransfer out;
    out.rule_error = relative_error * std::abs(b) * source.kernel_from(middle, frame.centre(), n);
    const bool is_near =
        ratio > calibrated::nearest_integrated_ratio ||
        (ratio > calibrated::farthest_integrated_ratio && out.rule_error > calibrated::negligible_link_share * allowed);
    if (is_near) {
        outline_ = sites_.tree().outline(source.element);
        out.rule_error = 0;
        ++form_factors_;
    }
    const std::span<const Vec2> at = checks_.at(frame.shape);
    std::array<double, 5> F{};
    for (std::size_t i = 0; i < at.size(); ++i) {
        const Point x = frame.at(at[i]);
        F[i] = is_near ? std::max(0.0, point_to_polygon(x, n, outline_)) : source.kernel_from(middle, x, n);
        // All points except the centre are nearly a Gauss rule of that many points.
        if (i > 0) out.form_factor += F[i] / static_cast<double>(at.size() - 1);
    }
    for (std::size_t i = 0; i < at.size(); ++i) out.departure[i] = (F[i] - out.form_factor) * b;
    return out;
}

double OpenTransferRule::interpolated(const OpenTransfer& transfer, ElementId receiver, const Point& x) const {
    const Patch frame = sites_.frame(receiver);
    std::array<double, 9> factors{};
    sites_.basis().interpolate(frame.shape, frame.coordinates(x), std::span(factors).first(nodes_));
    double sum = 0;
    for (std::size_t k = 0; k < nodes_; ++k) sum += factors[k] * transfer.light[k];
    return sum;
}

double OpenTransferRule::scale_of_kernel(const OpenTransfer& transfer, ElementId receiver, const SourceLight& source) {
    if (transfer.near) return transfer.kernel_scale;
    if (std::pow(transfer.ratio, 2 * sites_.basis().order()) < calibrated::kernel_scale_error) return 1;
    const Normal& n = sites_.normal(receiver);
    const std::vector<Point> outline = sites_.tree().outline(source.element);
    double exact = 0, rule = 0;
    for (std::size_t k = 0; k < nodes_; ++k) {
        exact += sites_.weight(receiver, k) * point_to_polygon(sites_.receiving_node(receiver, k), n, outline);
        for (std::size_t l = 0; l < nodes_; ++l) rule += sites_.weight(receiver, k) * transfer.rows[k][l];
    }
    ++form_factors_;
    return scale_to(exact, rule);
}

}  // namespace exitance
