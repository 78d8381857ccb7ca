#include "exitance/lab/flatland/growing_lines.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/random.hpp"
#include "exitance/lab/growing_cells/growing_cells.hpp"
#include "exitance/lab/growing_cells/least_squares.hpp"

namespace exitance::flatland {
namespace {

/// Resource that every sample adds, relative to its squared target. Units are inserted by error; this share keeps them
/// away from places where there is nothing to learn.
constexpr double density_share = 0.01;
constexpr std::size_t places_per_line = GrownKernel::side;  ///< Points per dimension at which errors are measured.

/// The function to learn: its value at a sample of n coordinates, which are computed from k numbers in [0, 1].
struct LearnedFunction {
    std::size_t k, n;
    std::function<std::vector<double>(std::span<const double>)> place;
    std::function<double(std::span<const double>)> value;
};

class Learner {
  public:
    Learner(const LearnedFunction& function, const GrowingLinesOptions& options)
        : function_(function),
          options_(options),
          random_(options.seed, Stream::mesh, function.n, 0),
          cells_(network(), corners()) {}

    void grow(std::size_t units) {
        while (cells_.unit_count() < units) {
            for (std::size_t i = 0; i < options_.samples_a_unit; ++i) learn(drawn());
            cells_.insert();
        }
    }

    /// Error with outputs as requested in the options, and the learned values at the points where it is measured.
    /// Growth continues from the outputs of the delta rule.
    double error(std::vector<double>* values = nullptr) {
        cells_.refresh();
        const std::vector<GrowingCells::Unit> units = cells_.units();
        std::vector<double> learned;
        for (const GrowingCells::Unit u : units) learned.push_back(std::as_const(cells_).output(u)[0]);
        if (options_.weights != CellWeights::delta_rule) fit(units, learned);
        const double found = measured_error(values);
        for (std::size_t i = 0; i < units.size(); ++i) cells_.output(units[i])[0] = learned[i];
        return found;
    }

    /// The units after a call of `error`.
    const GrowingCells& cells() const { return cells_; }

  private:
    GrowingCellsOptions network() const {
        GrowingCellsOptions out;
        out.simplex = function_.k, out.dimension = function_.n, out.outputs = 1;
        out.normalised = options_.weights == CellWeights::normalised_least_squares;
        return out;
    }
    std::vector<double> drawn() {
        std::vector<double> s(function_.k);
        for (double& x : s) x = random_.uniform();
        return s;
    }
    std::vector<double> corners() {
        std::vector<double> out;
        for (std::size_t i = 0; i <= function_.k; ++i)
            for (const double x : function_.place(drawn())) out.push_back(x);
        return out;
    }
    void learn(std::vector<double> s) {
        const double target = function_.value(s);
        cells_.learn(function_.place(s), std::span(&target, 1), density_share * target * target, 1);
        samples_.push_back(std::move(s));
    }

    void fit(const std::vector<GrowingCells::Unit>& units, std::vector<double> values) {
        std::vector<std::uint32_t> number(cells_.complex().unit_end());
        for (std::uint32_t i = 0; i < units.size(); ++i) number[units[i]] = i;
        FitProblem problem;
        problem.samples = samples_.size(), problem.unknowns = units.size();
        problem.row = [&](std::size_t s, FitRow& row) {
            double sum = 0;
            cells_.visit(function_.place(samples_[s]), [&](GrowingCells::Unit u, double w) {
                row.emplace_back(number[u], w);
                sum += w;
            });
            if (cells_.options().normalised)
                for (auto& entry : row) entry.second /= sum;
        };
        problem.target = [&](std::size_t s, std::size_t) { return function_.value(samples_[s]); };
        problem.weight = [](std::size_t) { return 1.0; };
        fit_least_squares(problem, values);
        for (std::size_t i = 0; i < units.size(); ++i) cells_.output(units[i])[0] = values[i];
    }

    double measured_error(std::vector<double>* values) const {
        double off = 0, all = 0;
        std::vector<std::size_t> at(function_.k, 0);
        for (;;) {
            std::vector<double> s;
            for (const std::size_t i : at) s.push_back((static_cast<double>(i) + 0.5) / places_per_line);
            double found = 0;
            cells_.evaluate(function_.place(s), std::span(&found, 1));
            if (values) values->push_back(found);
            const double right = function_.value(s);
            off += (found - right) * (found - right), all += right * right;
            std::size_t digit = 0;
            while (digit < at.size() && ++at[digit] == places_per_line) at[digit++] = 0;
            if (digit == at.size()) return std::sqrt(off / all);
        }
    }

    const LearnedFunction& function_;
    GrowingLinesOptions options_;
    RandomStream random_;
    GrowingCells cells_;
    std::vector<std::vector<double>> samples_;
};

std::vector<double> errors_of(const LearnedFunction& function, std::span<const std::size_t> units,
                              const GrowingLinesOptions& options) {
    Learner learner(function, options);
    std::vector<double> errors;
    for (const std::size_t count : units) {
        learner.grow(count);
        errors.push_back(learner.error());
    }
    return errors;
}

LearnedFunction between_lines(const std::function<double(double, double)>& kernel, double h) {
    return {2, 4,
            [h](std::span<const double> s) {
                return std::vector{s[0], 0.0, s[1], h};
            },
            [&](std::span<const double> s) { return kernel(s[0], s[1]); }};
}

}  // namespace

std::vector<double> errors_of_growing_kernel(const std::function<double(double, double)>& kernel, double h,
                                             std::span<const std::size_t> units, const GrowingLinesOptions& options) {
    return errors_of(between_lines(kernel, h), units, options);
}

std::vector<GrownKernel> grow_kernel(const std::function<double(double, double)>& kernel, double h,
                                     std::span<const std::size_t> units, const GrowingLinesOptions& options) {
    const LearnedFunction function = between_lines(kernel, h);
    Learner learner(function, options);
    std::vector<GrownKernel> out;
    for (const std::size_t count : units) {
        learner.grow(count);
        GrownKernel& grown = out.emplace_back();
        grown.error = learner.error(&grown.values);
        for (const GrowingCells::Unit u : learner.cells().units()) {
            const std::span<const double> at = learner.cells().position(u);  // x, 0, y, h
            grown.centres.push_back({at[0], at[2]});
            grown.widths.push_back(learner.cells().width(u));
        }
    }
    return out;
}

}  // namespace exitance::flatland
