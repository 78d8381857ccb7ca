#include "exitance/io/scenes/textures/texture_cuts.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

namespace exitance {
namespace {

class TextureCutter {
  public:
    TextureCutter(const ColourGrid& grid, const CutScale& scale, double metres_s, double metres_t)
        : grid_(grid), scale_(scale), metres_s_(metres_s), metres_t_(metres_t) {}

    TextureCuts cut(std::size_t max_cuts) {
        add(grid_.whole(), HUGE_VAL);
        while (!open_.empty() && out_.cuts.size() < max_cuts) {
            const Choice best = open_.top();
            open_.pop();
            out_.cuts.push_back({best.part, best.benefit});
            const GridBox box = boxes_[best.part];
            GridBox below = box, above = box;
            (best.along_s ? below.i1 : below.j1) = best.border;
            (best.along_s ? above.i0 : above.j0) = best.border;
            TexturePart& part = out_.parts[best.part];
            part.is_cut = true, part.along_s = best.along_s, part.children = out_.parts.size();
            part.at = (best.along_s ? grid_.columns() : grid_.rows())[best.border];
            add(below, best.benefit), add(above, best.benefit);
        }
        return std::move(out_);
    }

  private:
    /// The best cut of a part.
    struct Choice {
        double benefit = 0;
        std::size_t part = 0, border = 0;
        bool along_s = false;
        /// Equal benefits: the part that was added first.
        bool operator<(const Choice& o) const { return benefit != o.benefit ? benefit < o.benefit : part > o.part; }
    };

    void add(const GridBox& box, double at_most) {
        const std::size_t part = out_.parts.size();
        out_.parts.push_back({grid_.colour(box), grid_.mean(box).area});
        boxes_.push_back(box);
        Choice choice = best_cut(box);
        choice.part = part, choice.benefit = std::min(choice.benefit, at_most);
        if (choice.benefit > 0 && choice.benefit >= scale_.min_benefit) open_.push(choice);
    }

    Choice best_cut(const GridBox& box) const {
        Choice best;
        const ColourGrid::Cell whole = grid_.mean(box);
        if (!(whole.area > 0)) return best;
        const auto try_cuts = [&](bool along_s, std::size_t first, std::size_t last) {
            for (std::size_t border = first + 1; border < last; ++border) {
                GridBox below = box, above = box;
                (along_s ? below.i1 : below.j1) = border, (along_s ? above.i0 : above.j0) = border;
                Difference difference;
                difference.add(grid_.mean(below), whole), difference.add(grid_.mean(above), whole);
                const double benefit = benefit_of(difference, whole.area, 2);
                if (benefit > best.benefit) best = {benefit, 0, border, along_s};
            }
        };
        try_cuts(true, box.i0, box.i1), try_cuts(false, box.j0, box.j1);
        // If several cuts do far more per cut than the best single one, cut in the middle and count their benefit.
        constexpr double min_gain = 2;
        const double later = pattern_benefit(box, whole);
        if (later > min_gain * best.benefit) best = middle_cut(box, later);
        return best;
    }

    /// Sums of squared differences of reflectance and coverage, and of misplaced flux, between parts and their union.
    struct Difference {
        double squares = 0, flux = 0, holes = 0;
        void add(const ColourGrid::Cell& part, const ColourGrid::Cell& whole) {
            const double opaque = part.area * part.coverage;
            for (std::size_t b = 0; b < bands; ++b) {
                const double r = part.reflectance[b] - whole.reflectance[b], m = part.exitance[b] - whole.exitance[b];
                squares += opaque * r * r / bands, flux += 0.5 * opaque * std::abs(m) / bands;
            }
            const double c = part.coverage - whole.coverage;
            holes += part.area * c * c;
        }
    };

    /// Benefit per cut of dividing an area into `count` parts.
    double benefit_of(const Difference& difference, double area, std::size_t count) const {
        const double near = std::min(1.0, std::sqrt(area / static_cast<double>(count)) / scale_.length);
        const auto cuts = static_cast<double>(count - 1);
        const double moved = difference.flux * near / (cuts * scale_.flux);
        const double variance = difference.squares / scale_.reflected + difference.holes / scale_.area;
        return variance * near / cuts + moved * moved;
    }

    /// Largest benefit per cut of 2^k x 2^k equal boxes.
    double pattern_benefit(const GridBox& box, const ColourGrid::Cell& whole) const {
        constexpr std::size_t max_side = 8;  // boxes; derived from the default number of parts
        double best = 0;
        const std::size_t nx = box.i1 - box.i0, ny = box.j1 - box.j0;
        for (std::size_t side = 2; side <= max_side && side <= std::min(nx, ny); side *= 2) {
            Difference difference;
            for (std::size_t j = 0; j < side; ++j)
                for (std::size_t i = 0; i < side; ++i)
                    difference.add(grid_.mean({box.i0 + i * nx / side, box.i0 + (i + 1) * nx / side,
                                               box.j0 + j * ny / side, box.j0 + (j + 1) * ny / side}),
                                   whole);
            best = std::max(best, benefit_of(difference, whole.area, side * side));
        }
        return best;
    }

    Choice middle_cut(const GridBox& box, double benefit) const {
        const double across = metres_s_ * (grid_.columns()[box.i1] - grid_.columns()[box.i0]);
        const double down = metres_t_ * (grid_.rows()[box.j1] - grid_.rows()[box.j0]);
        const bool along_s = box.j1 - box.j0 < 2 || (across >= down && box.i1 - box.i0 >= 2);
        const std::size_t border = along_s ? box.i0 + (box.i1 - box.i0) / 2 : box.j0 + (box.j1 - box.j0) / 2;
        return {benefit, 0, border, along_s};
    }

    const ColourGrid& grid_;
    const CutScale& scale_;
    double metres_s_, metres_t_;
    TextureCuts out_;
    std::vector<GridBox> boxes_;  ///< Per part.
    std::priority_queue<Choice> open_;
};

}  // namespace

TextureCuts cut_texture(const ColourGrid& grid, const CutScale& scale, std::size_t max_cuts, double metres_s,
                        double metres_t) {
    return TextureCutter(grid, scale, metres_s, metres_t).cut(max_cuts);
}

}  // namespace exitance
