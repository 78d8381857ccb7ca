#include "exitance/io/report/requirements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "exitance/base/words.hpp"

namespace exitance {
namespace {

constexpr std::array<const char*, 4> computed_quantities{"Em", "U0", "Ez", "UGR"};

/// False for quantities of tasks that the report does not compute: colour rendering, and light on walls and ceilings.
bool is_measurable(const std::string& quantity) {
    return std::find(computed_quantities.begin(), computed_quantities.end(), quantity) != computed_quantities.end();
}

Error misuse(const std::string& words, const std::string& why) {
    return {ErrorCode::usage, why, "--require '" + words + "'",
            "for example: --require 'desk: Em 500, U0 0.6' or 'UGR 19'"};
}

/// Illuminance that the immediate surroundings of a task area need, lx: one step below that of the task on the scale of
/// EN 12464-1, but no more than 500 lx, and as much as the task's up to 200 lx. Source: TRILUX, "Illuminance in the
/// immediate surrounding area".
double light_of_surroundings(double task) {
    constexpr std::array<std::pair<double, double>, 3> steps{
        {{750, 500}, {500, 300}, {300, 200}}};  // lx, derived from the table: task, surroundings
    for (const auto& [least, surroundings] : steps)
        if (task >= least) return surroundings;
    return std::min(task, steps.back().second);
}

/// Number that a zone around a task area needs where the task area needs `task`. Sources: TRILUX, "Background lighting"
/// (a third of the surroundings, U_0 0.10) and "Uniformity of illuminance" (U_0 0.40).
double required_in(PlaneZone zone, const std::string& quantity, double task) {
    constexpr double uniform_surroundings = 0.4, uniform_background = 0.1;  // derived from the sources above
    constexpr double background_share = 1.0 / 3;                            // derived from the sources above
    if (zone == PlaneZone::task) return task;
    const bool is_near = zone == PlaneZone::surroundings;
    if (quantity == "U0") return is_near ? uniform_surroundings : uniform_background;
    return (is_near ? 1 : background_share) * light_of_surroundings(task);
}

Fulfilment verdict_on(double reached, double required, double error, bool is_upper_limit) {
    const double excess = is_upper_limit ? required - reached : reached - required;
    if (excess >= 0) return Fulfilment::reached;
    return -excess <= error ? Fulfilment::within_error : Fulfilment::missed;
}

class Judge {
    /// The place that a requirement names: its words, and the task after a room's label.
    struct Place {
        std::string words, task;
        std::optional<std::size_t> room;
    };

  public:
    Judge(const ReportContent& content, const ReportFigures& figures)
        : content_(content),
          figures_(figures),
          error_(content.solution->statistics.relative_error_estimate.value_or(0)) {}

    void judge_planes(const Requirement& asked, const Requirement::Limit& limit) {
        const Place place = place_of(asked);
        const std::size_t before = out_.size();
        const bool is_cylindrical = limit.quantity == "Ez";
        for (const ReportFigures::Grid& grid : figures_.grids) {
            if (grid.light->is_cylindrical != is_cylindrical) continue;
            const std::optional<double> required = required_of(*grid.light, asked, place, limit);
            if (!required) continue;
            const bool is_uniformity = limit.quantity == "U0";
            const double reached = is_uniformity ? grid.levels.uniformity() : grid.levels.mean;
            // A quotient has the errors of two numbers.
            const double error = (is_uniformity ? 2 : 1) * error_ * reached;
            out_.push_back({grid.light->name.empty() ? "plane" : grid.light->name, limit.quantity, place.task,
                            *required, reached, verdict_on(reached, *required, error, false)});
        }
        if (out_.size() == before) add_unmeasured(place, limit, "planes");
    }

    void add_unmeasured(const Place& place, const Requirement::Limit& limit, const std::string& where) {
        out_.push_back({place.words.empty() ? where : place.words, limit.quantity, place.task, limit.value});
    }

    /// The observer with the highest rating decides.
    void judge_glare(const Requirement& asked, const Requirement::Limit& limit) {
        const Place place = place_of(asked);
        Judgement out{place.words.empty() ? "observers" : place.words, limit.quantity, place.task, limit.value};
        double worst = -HUGE_VAL;
        bool is_measured = false;
        for (const ObserverGlare& o : content_.observers) {
            if (!asked.plane.empty() && !is_in(place, o.observer.room)) continue;
            is_measured = true;
            if (std::isfinite(o.glare.rating()) && o.glare.rating() > worst)
                worst = o.glare.rating(), out.where = o.observer.name;
        }
        // Ratings are minus infinity where no source counts.
        if (is_measured)
            out.reached = std::max(worst, 0.0),
            out.verdict = verdict_on(out.reached, limit.value, 8 * std::log10(1 + error_), true);
        out_.push_back(out);
    }

    std::vector<Judgement> all() {
        for (const Requirement& asked : content_.requirements)
            for (const Requirement::Limit& limit : asked.limits)
                limit.quantity == "UGR"         ? judge_glare(asked, limit)
                : is_measurable(limit.quantity) ? judge_planes(asked, limit)
                                                : add_unmeasured(place_of(asked), limit, "");
        return std::move(out_);
    }

  private:
    Place place_of(const Requirement& asked) const {
        for (std::size_t i = 0; i < content_.rooms.count(); ++i) {
            const std::string label = content_.rooms.label(i);
            if (asked.plane == label || asked.plane == fmt::format("room {}", i + 1)) return {label, "", i};
            if (asked.plane.starts_with(label + ": ")) return {label, asked.plane.substr(label.size() + 2), i};
        }
        return {asked.plane, "", std::nullopt};
    }
    /// Number that a requirement demands of a plane; none if it does not concern the plane.
    std::optional<double> required_of(const GridLight& light, const Requirement& asked, const Place& place,
                                      const Requirement::Limit& limit) const {
        if (!asked.plane.empty() && light.name == asked.plane) return limit.value;
        const bool is_around_it = light.zone != PlaneZone::task && light.name.starts_with(asked.plane + ", ");
        if (!asked.plane.empty() && !is_around_it && !is_in(place, light.room)) return std::nullopt;
        // The steps of surroundings are in lx, and for horizontal light.
        if (light.zone != PlaneZone::task && (!content_.unit.is_lux() || light.is_cylindrical)) return std::nullopt;
        return required_in(light.zone, limit.quantity, limit.value);
    }
    static bool is_in(const Place& place, const std::optional<std::size_t>& room) {
        return place.room && room == place.room;
    }

    const ReportContent& content_;
    const ReportFigures& figures_;
    double error_;
    std::vector<Judgement> out_;
};

}  // namespace

Result<Requirement> read_requirement(const std::string& words) {
    Requirement out;
    const std::size_t colon = words.rfind(':');
    if (colon != std::string::npos) out.plane = without_blanks(words.substr(0, colon));
    std::istringstream items(colon == std::string::npos ? words : words.substr(colon + 1));
    for (std::string item; std::getline(items, item, ',');) {
        std::istringstream in(item);
        Requirement::Limit limit;
        std::string more;
        if (!(in >> limit.quantity >> limit.value) || in >> more || !(limit.value > 0) || !std::isfinite(limit.value))
            return misuse(words, fmt::format("'{}' is not a quantity and a positive number{}", without_blanks(item),
                                             more.empty() ? "" : "; separate quantities by commas"));
        if (std::find(computed_quantities.begin(), computed_quantities.end(), limit.quantity) ==
            computed_quantities.end())
            return misuse(words, fmt::format("'{}' is not Em, U0, Ez or UGR", limit.quantity));
        if (limit.quantity == "UGR" && !out.plane.empty() && !out.plane.starts_with("room "))
            return misuse(words, "UGR is required of observers, which have no plane: name a room, 'room 2: UGR 19'");
        out.limits.push_back(limit);
    }
    if (out.limits.empty()) return misuse(words, "names no quantity");
    return out;
}

std::vector<Judgement> judge(const ReportContent& content, const ReportFigures& figures) {
    return Judge(content, figures).all();
}

std::string words_of(Fulfilment verdict) {
    switch (verdict) {
        case Fulfilment::reached:
            return "reached";
        case Fulfilment::within_error:
            return "reached within the error";
        case Fulfilment::missed:
            return "missed";
        case Fulfilment::not_measured:
            return "not measured";
    }
    return "";
}

}  // namespace exitance
