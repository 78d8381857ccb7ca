#include "exitance/api/inside.hpp"

#include <fmt/format.h>

#include <cmath>

#include "exitance/scene/findings.hpp"

namespace exitance::api {

Error to_api(const exitance::Error& error) {
    return {static_cast<ErrorCode>(error.code), error.message, error.where, error.hint};
}

static_assert(static_cast<int>(ErrorCode::usage) == static_cast<int>(exitance::ErrorCode::usage) &&
              static_cast<int>(ErrorCode::failure) == static_cast<int>(exitance::ErrorCode::failure));

Finding to_api(const exitance::Finding& finding) {
    return {static_cast<Finding::Kind>(finding.kind), place_of(finding), finding.message, finding.hint};
}

static_assert(static_cast<int>(Finding::Kind::repair) == static_cast<int>(exitance::Finding::Kind::repair));

Result<void> to_api(const exitance::Result<void>& result) {
    if (!result) return to_api(result.error());
    return {};
}

Error usage(std::string message, std::string where, std::string hint) {
    return {ErrorCode::usage, std::move(message), std::move(where), std::move(hint)};
}

Error stopped(std::string_view what) {
    return {ErrorCode::limit, fmt::format("a stop was requested during {}", what), "", "allow more time"};
}

void Run::limit_time(const std::optional<double>& seconds) {
    if (!seconds) return;
    constexpr double max_seconds = 1e9;  ///< derived from the range of the clock, 2^63 ns
    const std::chrono::duration<double> limit(std::min(*seconds, max_seconds));
    stop_.set_deadline(exitance::StopRequest::Clock::now() +
                       std::chrono::duration_cast<exitance::StopRequest::Clock::duration>(limit));
}

Result<std::vector<ProbePoint>> to_engine(std::span<const Probe> probes) {
    // normals whose length is 1 up to rounding are used unchanged, as in probe files
    constexpr double rounding = 1e-11;
    std::vector<ProbePoint> out;
    out.reserve(probes.size());
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const exitance::Vec3 n = to_engine(probes[i].normal), x = to_engine(probes[i].point);
        const double length = norm(n);
        if (!is_finite(x) || !is_finite(n))
            return usage("has a coordinate that is not finite", fmt::format("probe {}", i));
        if (!(length > 0)) return usage("has a normal without length", fmt::format("probe {}", i));
        out.push_back({x, std::abs(length - 1) < rounding ? n : n / length});
    }
    return out;
}

std::timed_mutex& turns() {
    static std::timed_mutex mutex;
    return mutex;
}

}  // namespace exitance::api
