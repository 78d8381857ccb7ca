#include "exitance/lab/flatland/growing_lines.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/lab/growing_cells/growing_cells.hpp"
#include "exitance/lab/growing_cells/least_squares.hpp"

namespace exitance::flatland {
namespace {

/// Error makes units come; a little of density keeps them from where there is nothing to learn.
constexpr double density_share = 0.01;
constexpr std::size_t places_a_line = 64;  ///< At which errors are measured.

/// What is to be learned: a value at a sample of n coordinates, made of k numbers in [0, 1].
struct Lesson {
    std::size_t k, n;
    std::function<std::vector<double>(std::span<const double>)> place;
    std::function<double(std::span<const double>)> value;
};

class Pupil {
  public:
    Pupil(const Lesson& lesson, const GrowingLinesOptions& options)
        : lesson_(lesson),
          options_(options),
          random_(options.seed, Stream::mesh, lesson.n, 0),
          cells_(network(), corners()) {}

    void grow(std::size_t units) {
        while (cells_.unit_count() < units) {
            for (std::size_t i = 0; i < options_.samples_a_unit; ++i) learn(drawn());
            cells_.insert();
        }
    }

    /// Outputs as the options want them; growing goes on from those of the delta rule.
    double error() {
        cells_.refresh();
        const std::vector<GrowingCells::Unit> units = cells_.units();
        std::vector<double> learned;
        for (const GrowingCells::Unit u : units) learned.push_back(std::as_const(cells_).output(u)[0]);
        if (options_.weights != CellWeights::delta_rule) fit(units, learned);
        const double found = measured_error();
        for (std::size_t i = 0; i < units.size(); ++i) cells_.output(units[i])[0] = learned[i];
        return found;
    }

  private:
    GrowingCellsOptions network() const {
        GrowingCellsOptions out;
        out.simplex = lesson_.k, out.dimension = lesson_.n, out.outputs = 1;
        out.normalised = options_.weights == CellWeights::normalised_least_squares;
        return out;
    }
    std::vector<double> drawn() {
        std::vector<double> s(lesson_.k);
        for (double& x : s) x = random_.uniform();
        return s;
    }
    std::vector<double> corners() {
        std::vector<double> out;
        for (std::size_t i = 0; i <= lesson_.k; ++i)
            for (const double x : lesson_.place(drawn())) out.push_back(x);
        return out;
    }
    void learn(std::vector<double> s) {
        const double target = lesson_.value(s);
        cells_.learn(lesson_.place(s), std::span(&target, 1), density_share * target * target, 1);
        samples_.push_back(std::move(s));
    }

    void fit(const std::vector<GrowingCells::Unit>& units, std::vector<double> values) {
        std::vector<std::uint32_t> number(cells_.complex().unit_end());
        for (std::uint32_t i = 0; i < units.size(); ++i) number[units[i]] = i;
        FitProblem problem;
        problem.samples = samples_.size(), problem.unknowns = units.size();
        problem.row = [&](std::size_t s, FitRow& row) {
            double sum = 0;
            cells_.visit(lesson_.place(samples_[s]), [&](GrowingCells::Unit u, double w) {
                row.emplace_back(number[u], w);
                sum += w;
            });
            if (cells_.options().normalised)
                for (auto& entry : row) entry.second /= sum;
        };
        problem.target = [&](std::size_t s, std::size_t) { return lesson_.value(samples_[s]); };
        problem.weight = [](std::size_t) { return 1.0; };
        fit_least_squares(problem, values);
        for (std::size_t i = 0; i < units.size(); ++i) cells_.output(units[i])[0] = values[i];
    }

    double measured_error() const {
        double off = 0, all = 0;
        std::vector<std::size_t> at(lesson_.k, 0);
        for (;;) {
            std::vector<double> s;
            for (const std::size_t i : at) s.push_back((static_cast<double>(i) + 0.5) / places_a_line);
            double found = 0;
            cells_.evaluate(lesson_.place(s), std::span(&found, 1));
            const double right = lesson_.value(s);
            off += (found - right) * (found - right), all += right * right;
            std::size_t digit = 0;
            while (digit < at.size() && ++at[digit] == places_a_line) at[digit++] = 0;
            if (digit == at.size()) return std::sqrt(off / all);
        }
    }

    const Lesson& lesson_;
    GrowingLinesOptions options_;
    RandomStream random_;
    GrowingCells cells_;
    std::vector<std::vector<double>> samples_;
};

std::vector<double> errors_of(const Lesson& lesson, std::span<const std::size_t> units,
                              const GrowingLinesOptions& options) {
    Pupil pupil(lesson, options);
    std::vector<double> errors;
    for (const std::size_t count : units) {
        pupil.grow(count);
        errors.push_back(pupil.error());
    }
    return errors;
}

}  // namespace

std::vector<double> errors_of_growing_line(const std::function<double(double)>& f, std::span<const std::size_t> units,
                                           const GrowingLinesOptions& options) {
    return errors_of({1, 2,
                      [](std::span<const double> s) {
                          return std::vector{s[0], 0.0};
                      },
                      [&](std::span<const double> s) { return f(s[0]); }},
                     units, options);
}

std::vector<double> errors_of_growing_kernel(const std::function<double(double, double)>& kernel, double h,
                                             std::span<const std::size_t> units, const GrowingLinesOptions& options) {
    return errors_of({2, 4,
                      [h](std::span<const double> s) {
                          return std::vector{s[0], 0.0, s[1], h};
                      },
                      [&](std::span<const double> s) { return kernel(s[0], s[1]); }},
                     units, options);
}

}  // namespace exitance::flatland
