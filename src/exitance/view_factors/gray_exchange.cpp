#include "exitance/view_factors/gray_exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/base/distinct_numbers.hpp"

namespace exitance {
namespace {

constexpr double tolerance = 1e-12;      ///< Limit on the relative residual, derived from double precision.
constexpr double max_temperature = 1e5;  ///< K; hotter surfaces are mistakes, derived from the sun's 5,800 K.
constexpr double max_heat = 1e100;       ///< W; derived from double precision: balances of such heats do not overflow.
constexpr std::size_t max_iterations = 10'000;
constexpr double power_of_temperature = 4;

/// Black-body exitance, W/m^2.
double black(double temperature) {
    return stefan_boltzmann * std::pow(temperature, power_of_temperature);
}

Error wrong(std::string message, std::string hint) {
    return {ErrorCode::bad_input, std::move(message), "", std::move(hint)};
}

/// The symmetric system (D - S) J = b for the radiosities of surfaces, S_ij = A_i F_ij. Those of black surfaces with a
/// temperature are known.
class GraySystem {
  public:
    GraySystem(const ExchangeAreas& exchange, const std::vector<double>& areas,
               std::span<const ThermalSurface> surfaces, bool is_enclosure)
        : exchange_(exchange),
          surfaces_(surfaces),
          size_(exchange.size()),
          leak_(size_),
          known_(size_),
          diagonal_(size_) {
        area_ = incoming(std::vector<double>(size_, 1));
        for (std::size_t i = 0; i < size_; ++i) {
            leak_[i] = is_enclosure ? 0 : std::max(0.0, areas[i] - area_[i]);
            area_[i] += leak_[i];
            known_[i] = surfaces[i].temperature && surfaces[i].emissivity == 1;
            diagonal_[i] = surfaces[i].temperature && !known_[i] ? area_[i] / (1 - surfaces[i].emissivity) : area_[i];
        }
    }

    std::size_t size() const { return size_; }
    double area(std::size_t i) const { return area_[i]; }
    double leak(std::size_t i) const { return leak_[i]; }
    bool is_known(std::size_t i) const { return known_[i]; }

    /// S x
    std::vector<double> incoming(const std::vector<double>& x) const {
        std::vector<double> y(size_);
        exchange_.apply(x, y);
        return y;
    }

    struct Solution {
        std::vector<double> radiosity;
        double residual = 0;
        std::size_t iterations = 0;
        bool is_stopped = false;
    };

    /// Radiosities for black-body exitances `emitted` of the surfaces with a temperature, given heats of the others,
    /// and the exitance of the surroundings.
    Solution solve(const std::vector<double>& emitted, const std::vector<double>& heat, double surroundings,
                   const StopRequest& stop) const {
        Solution out;
        std::vector<double>& x = out.radiosity;
        x.assign(size_, 0);
        for (std::size_t i = 0; i < size_; ++i)
            if (known_[i]) x[i] = emitted[i];
        const std::vector<double> of_known = incoming(x);
        std::vector<double> r(size_), p(size_), q(size_);
        for (std::size_t i = 0; i < size_; ++i) {
            if (known_[i]) continue;
            const ThermalSurface& s = surfaces_[i];
            const double own = s.temperature ? area_[i] * s.emissivity / (1 - s.emissivity) * emitted[i] : heat[i];
            r[i] = own + leak_[i] * surroundings + of_known[i];  // unknown radiosities are still 0
        }
        const double unit = divide_by_largest(r);
        double scale = 0;
        for (std::size_t i = 0; i < size_; ++i) {
            if (known_[i]) continue;
            scale += r[i] * r[i] / diagonal_[i];
            p[i] = r[i] / diagonal_[i];
        }
        double rho = scale;
        for (; rho > tolerance * tolerance * scale && out.iterations < max_iterations; ++out.iterations) {
            if ((out.is_stopped = stop.requested())) break;
            const std::vector<double> arriving = incoming(p);
            double pq = 0;
            for (std::size_t i = 0; i < size_; ++i) {
                if (known_[i]) continue;
                q[i] = diagonal_[i] * p[i] - arriving[i];
                pq += p[i] * q[i];
            }
            const double alpha = rho / pq;
            double next = 0;
            for (std::size_t i = 0; i < size_; ++i) {
                if (known_[i]) continue;
                x[i] += alpha * p[i], r[i] -= alpha * q[i];
                next += r[i] * r[i] / diagonal_[i];
            }
            for (std::size_t i = 0; i < size_; ++i)
                if (!known_[i]) p[i] = r[i] / diagonal_[i] + next / rho * p[i];
            rho = next;
        }
        for (std::size_t i = 0; i < size_; ++i)
            if (!known_[i]) x[i] *= unit;
        out.residual = scale > 0 ? std::sqrt(rho / scale) : 0;
        return out;
    }

  private:
    /// Divides numbers by the largest absolute value among them, so that their squares neither overflow nor vanish.
    /// Returns the divisor.
    static double divide_by_largest(std::vector<double>& r) {
        double largest = 0;
        for (const double value : r) largest = std::max(largest, std::abs(value));
        if (largest > 0)
            for (double& value : r) value /= largest;
        return largest;
    }

    const ExchangeAreas& exchange_;
    std::span<const ThermalSurface> surfaces_;
    std::size_t size_;
    std::vector<double> area_, leak_;
    std::vector<std::uint8_t> known_;
    std::vector<double> diagonal_;
};

/// True if the balance determines all temperatures: every surface exchanges heat, directly or by way of other surfaces,
/// with a surface of given temperature or with the surroundings.
bool is_determined(const GraySystem& system, std::span<const ThermalSurface> surfaces, bool has_surroundings) {
    std::vector<double> reached(system.size());
    for (std::size_t i = 0; i < system.size(); ++i)
        reached[i] = surfaces[i].temperature || (has_surroundings && system.leak(i) > 0) || !(system.area(i) > 0);
    for (bool grows = true; grows;) {
        grows = false;
        const std::vector<double> arriving = system.incoming(reached);
        for (std::size_t i = 0; i < system.size(); ++i)
            if (reached[i] == 0 && arriving[i] > 0) reached[i] = 1, grows = true;
    }
    return std::all_of(reached.begin(), reached.end(), [](double r) { return r > 0; });
}

/// An error if a surface sees an opening: its row misses more than the factors' error explains.
Result<void> check_closed(const SparseFactors& factors) {
    constexpr double allowed = 0.01;  // derived from default_row_error: rows of that accuracy miss a tenth of this
    std::size_t open = 0;
    double least = 1;
    for (std::size_t i = 0; i < factors.size(); ++i) {
        double sum = 0;
        for (const double F : factors.row_values(i)) sum += F;
        const double error = i < factors.row_errors.size() ? factors.row_errors[i] : 0;
        if (sum >= 1 - allowed - 3 * error || !(factors.areas[i] > 0)) continue;
        ++open, least = std::min(least, sum);
    }
    if (open == 0) return {};
    return wrong(fmt::format("{} of {} surfaces see openings: their view factors add up to {:.3g} or more", open,
                             factors.size(), least),
                 "give the temperature behind the openings: --surroundings K");
}

Result<void> check(const SparseFactors& factors, std::span<const ThermalSurface> surfaces,
                   std::optional<double> surroundings) {
    if (surfaces.size() != factors.size())
        return wrong(fmt::format("{} surfaces for {} rows of view factors", surfaces.size(), factors.size()),
                     "give one row for each surface of the table of view factors");
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const ThermalSurface& s = surfaces[i];
        if (!(s.emissivity >= min_emissivity && s.emissivity <= 1))
            return wrong(
                fmt::format("surface {}: emissivity {} is not from {} to 1", i + 1, s.emissivity, min_emissivity),
                "a mirror-like surface has an emissivity of 0.02 or more");
        if (s.temperature && !(*s.temperature >= 0 && *s.temperature < max_temperature))
            return wrong(fmt::format("surface {}: temperature {} is out of range", i + 1, *s.temperature),
                         fmt::format("temperatures are in kelvins, from 0 to below {}", max_temperature));
        if (!s.temperature && !(std::abs(s.heat) <= max_heat))
            return wrong(fmt::format("surface {}: heat {} is out of range", i + 1, s.heat),
                         "heat is in watts, of the whole surface, and at most 1e100");
    }
    if (!surroundings) return check_closed(factors);
    if (!(*surroundings >= 0 && *surroundings < max_temperature))
        return wrong("the temperature of the surroundings is out of range", "temperatures are in kelvins");
    return {};
}

Error undetermined() {
    return wrong(
        "nothing determines the temperatures of some surfaces: they exchange heat with no surface of given "
        "temperature",
        "give a temperature for one of them, or that of the surroundings");
}

Error stopped() {
    return {ErrorCode::limit, "stopped before the heat balance was solved", "", "allow more time"};
}

/// A value >= 0 with four digits, not larger than it was, so that a limit in a message is within the limit.
double rounded_down(double value) {
    constexpr double ten = 10, further_digits = 3;  // derived from the format of messages, {:.4g}
    if (!(value > 0)) return 0;
    const double last_digit = std::pow(ten, std::floor(std::log10(value)) - further_digits);
    return std::floor(value / last_digit) * last_digit;
}

/// The error of a heat balance in which surface `sink` and others of `is_too_cold` would be colder than absolute zero:
/// states the heat that it takes up if these surfaces are at absolute zero.
Error too_cold(const ExchangeAreas& exchange, const SparseFactors& factors, std::span<const ThermalSurface> surfaces,
               std::optional<double> surroundings, std::size_t sink, const std::vector<std::uint8_t>& is_too_cold,
               const StopRequest& stop) {
    std::vector<ThermalSurface> coldest(surfaces.begin(), surfaces.end());
    std::vector<double> emitted, heat;
    for (std::size_t i = 0; i < coldest.size(); ++i) {
        if (is_too_cold[i]) coldest[i].temperature = 0;
        emitted.push_back(black(coldest[i].temperature.value_or(0)));
        heat.push_back(coldest[i].temperature ? 0 : coldest[i].heat);
    }
    const GraySystem system(exchange, factors.areas, coldest, !surroundings);
    const double sky = black(surroundings.value_or(0));
    const GraySystem::Solution solved = system.solve(emitted, heat, sky, stop);
    if (solved.is_stopped) return stopped();
    const double most = rounded_down(std::max(0.0, system.incoming(solved.radiosity)[sink] + system.leak(sink) * sky -
                                                       system.area(sink) * solved.radiosity[sink]));
    const auto others = std::count(is_too_cold.begin(), is_too_cold.end(), 1) - 1;
    return wrong(
        fmt::format("surface {} cannot take up {:.10g} W: at absolute zero it takes up {:.4g} W{}", sink + 1,
                    -surfaces[sink].heat, most,
                    others == 0 ? "" : fmt::format(" ({} more {} too cold, too)", others, others == 1 ? "is" : "are")),
        fmt::format("give it a heat of {:.4g} W or more (negative heat is taken up, positive heat is given off), make "
                    "others hotter, or give its temperature in place of its heat",
                    0 - most));
}

/// The heat balance of surfaces between which heat is exchanged; `factors` are the rows on which `exchange` is based.
Result<GrayExchange> balance(const ExchangeAreas& exchange, const SparseFactors& factors,
                             std::span<const ThermalSurface> surfaces, std::optional<double> surroundings,
                             const StopRequest& stop) {
    const GraySystem system(exchange, factors.areas, surfaces, !surroundings);
    if (!is_determined(system, surfaces, surroundings.has_value())) return undetermined();
    std::vector<double> emitted, heat;
    for (const ThermalSurface& s : surfaces)
        emitted.push_back(black(s.temperature.value_or(0))), heat.push_back(s.temperature ? 0 : s.heat);
    const double sky = black(surroundings.value_or(0));
    GraySystem::Solution solved = system.solve(emitted, heat, sky, stop);
    if (solved.is_stopped) return stopped();
    GrayExchange out{.temperature = {},
                     .radiosity = std::move(solved.radiosity),
                     .heat = {},
                     .residual = solved.residual,
                     .iterations = solved.iterations};
    const std::vector<double> arriving = system.incoming(out.radiosity);
    std::vector<std::uint8_t> is_too_cold(surfaces.size());
    double lowest = 0, highest = 0;  // black-body exitances of surfaces with a given heat, W/m^2
    std::size_t coldest = 0, hottest = 0;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        const double J = out.radiosity[i], e = surfaces[i].emissivity;
        const double Q = system.area(i) * J - arriving[i] - system.leak(i) * sky;
        out.heat.push_back(Q);
        out.surroundings += system.leak(i) * (J - sky);
        if (surfaces[i].temperature) {
            out.temperature.push_back(*surfaces[i].temperature);
            continue;
        }
        // An adiabatic surface can be too cold or too hot only if a surface with heat is.
        // The given heat rather than Q, whose rounding error a small emissivity would magnify.
        const double exitance = J + (system.area(i) > 0 ? (1 - e) / e * surfaces[i].heat / system.area(i) : 0);
        if (exitance < 0 && surfaces[i].heat < 0) {
            is_too_cold[i] = 1;
            if (exitance < lowest) lowest = exitance, coldest = i;
        }
        if (exitance > highest && surfaces[i].heat > 0) highest = exitance, hottest = i;
        out.temperature.push_back(std::pow(std::max(0.0, exitance) / stefan_boltzmann, 1 / power_of_temperature));
    }
    if (lowest < 0) return too_cold(exchange, factors, surfaces, surroundings, coldest, is_too_cold, stop);
    if (highest >= black(max_temperature))
        return wrong(
            fmt::format("surface {} would have {:.4g} K to give off {:g} W", hottest + 1, out.temperature[hottest],
                        surfaces[hottest].heat),
            "give it a smaller heat (in watts, of the whole surface), or its temperature in place of its heat");
    return out;
}

}  // namespace

bool is_enclosure(const SparseFactors& factors) {
    return static_cast<bool>(check_closed(factors));
}

Result<GrayExchange> solve_gray_exchange(const SparseFactors& factors, std::span<const ThermalSurface> surfaces,
                                         std::optional<double> surroundings, const StopRequest& stop) {
    if (const Result<void> checked = check(factors, surfaces, surroundings); !checked) return checked.error();
    return balance(TableExchange(factors), factors, surfaces, surroundings, stop);
}

Result<GrayExchange> solve_gray_exchange(const FactorOperator& transport, std::span<const ThermalSurface> surfaces,
                                         std::optional<double> surroundings, const StopRequest& stop) {
    if (const Result<void> checked = check(transport.rows, surfaces, surroundings); !checked) return checked.error();
    return balance(OperatorExchange(transport), transport.rows, surfaces, surroundings, stop);
}

Result<std::vector<std::vector<double>>> exchange_factors(const SparseFactors& factors,
                                                          std::span<const ThermalSurface> surfaces,
                                                          std::optional<double> surroundings, const StopRequest& stop) {
    if (const Result<void> checked = check(factors, surfaces, surroundings); !checked) return checked.error();
    const TableExchange table(factors);
    const GraySystem system(table, factors.areas, surfaces, !surroundings);
    if (!is_determined(system, surfaces, surroundings.has_value())) return undetermined();
    const std::size_t n = surfaces.size();
    const std::vector<double> no_heat(n);
    std::vector<std::vector<double>> out(n, std::vector<double>(n));
    for (std::size_t j = 0; j < n; ++j) {
        if (!surfaces[j].temperature) continue;
        // With surface j alone emitting, the others absorb e_i H_i; the factors are symmetric: A_i f_ij = A_j f_ji.
        std::vector<double> emitted(n);
        emitted[j] = 1;
        const GraySystem::Solution solved = system.solve(emitted, no_heat, 0, stop);
        if (solved.is_stopped) return stopped();
        const std::vector<double> arriving = system.incoming(solved.radiosity);
        for (std::size_t i = 0; i < n; ++i) {
            if (!surfaces[i].temperature || !(system.area(i) > 0)) continue;
            out[j][i] = surfaces[i].emissivity * arriving[i] / system.area(j);
        }
    }
    return out;
}

}  // namespace exitance
