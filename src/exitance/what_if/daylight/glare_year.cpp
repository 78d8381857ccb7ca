#include "exitance/what_if/daylight/glare_year.hpp"

#include <algorithm>

#include "exitance/base/parallel.hpp"

namespace exitance {
namespace {

/// Glare term of the sun for its illuminance of the eye's plane, lx.
double sun_term(const SurfacePoint& eye, const Normal& towards, double illuminance) {
    const double cosine = dot(towards, eye.n);
    if (!(illuminance > 0 && cosine > 0)) return 0;
    const double L = illuminance / (cosine * sun_disc_solid_angle), P = daylight_position(eye.n, towards);
    return L * L * sun_disc_solid_angle / (P * P);
}

}  // namespace

int GlareStatistics::level() const {
    for (std::size_t k = 0; k < exceeded.size(); ++k)
        if (exceeded[k] <= allowed_share) return static_cast<int>(exceeded.size() - k);
    return 0;
}

GlareStatistics glare_statistics(std::span<const float> probabilities, std::span<const DaylightHour> hours,
                                 const DaylightCriteria& criteria) {
    std::vector<double> occupied;
    for (std::size_t h = 0; h < hours.size(); ++h)
        if (criteria.is_occupied(hours[h], h)) occupied.push_back(double(probabilities[h]));
    GlareStatistics out;
    if (occupied.empty()) return out;
    std::sort(occupied.begin(), occupied.end(), std::greater<>());
    const auto count = static_cast<double>(occupied.size());
    for (std::size_t k = 0; k < out.exceeded.size(); ++k)
        out.exceeded[k] = static_cast<double>(std::count_if(occupied.begin(), occupied.end(),
                                                            [&](double p) { return p > glare_limits[k]; })) /
                          count;
    out.worst = occupied.front();
    out.reached = occupied[static_cast<std::size_t>(GlareStatistics::allowed_share * count)];
    return out;
}

GlareSummary summary_of(std::span<const GlareYear> years) {
    GlareSummary out;
    out.views = years.size(), out.level = years.empty() ? 0 : 3;
    for (const GlareYear& year : years) {
        const int level = year.statistics.level();
        out.level = std::min(out.level, level), out.worst = std::max(out.worst, year.statistics.reached);
        for (int k = 1; k <= level; ++k)
            out.at_level[static_cast<std::size_t>(k - 1)] += 1 / static_cast<double>(years.size());
    }
    return out;
}

GlareYear GlareYears::evaluate(const SurfacePoint& eye, std::span<const float> illuminance,
                               std::span<const float> sun) const {
    const YearSky& sky = setting_.sky;
    const GlareView view(transport_, setting_.patches, bright_, eye);
    GlareView::Workspace workspace;
    GlareYear out;
    out.probability.assign(sky.hours(), 0.0F);
    for (std::size_t k = 0; k < sky.bright_hours().size(); ++k) {
        const std::size_t h = sky.bright_hours()[k];
        const double terms = view.terms(sky.sky_luminances(k), bright_.in_hour(k), threshold_, workspace) +
                             sun_term(eye, sky.sun(h).towards, double(sun[h]));
        out.probability[h] = static_cast<float>(daylight_glare_probability(double(illuminance[h]), terms));
    }
    out.statistics = glare_statistics(out.probability, setting_.hours, setting_.criteria);
    return out;
}

std::vector<GlareYear> GlareYears::evaluate(std::span<const SurfacePoint> eyes, const DaylightBlock& block) const {
    const std::size_t hours = setting_.sky.hours();
    std::vector<GlareYear> out(eyes.size());
    parallel_for(eyes.size(), 1, [&](std::size_t i) {
        const auto row = [&](const std::vector<float>& values) { return std::span(values).subspan(i * hours, hours); };
        out[i] = evaluate(eyes[i], row(block.illuminance), row(block.sun));
    });
    return out;
}

}  // namespace exitance
