#include "exitance/error/mean_residuals.hpp"

#include <algorithm>

namespace exitance {
namespace {

/// Deviations of the samples of one element from the mean of its parent.
struct Beyond {
    Spectrum sum, square;  ///< Sums of the weighted deviations and of their squares.
    double weight = 0;
    double count = 0;

    void add(double w, const Spectrum& residual) {
        sum += w * residual, square += w * w * residual * residual;
        weight += w, ++count;
    }
};

/// Correlation of the deviations of different samples of one element: the mean product of different samples divided by
/// the mean square of single ones.
class Agreement {
  public:
    void count(const Beyond& element) {
        if (element.count < 2) return;
        common_ += mean(element.sum * element.sum - element.square) / (element.count - 1);
        all_ += mean(element.square);
    }
    /// Returns the mean of an element's samples, shrunk towards zero according to the correlation.
    Spectrum drawn(const Beyond& element) const {
        const double share = all_ > 0 ? std::clamp(common_ / all_, 0.0, 1.0) : 0;
        return share * element.count / (1 + share * (element.count - 1)) / element.weight * element.sum;
    }

  private:
    double common_ = 0, all_ = 0;
};

/// Returns the means of the groups, shrunk towards zero.
std::vector<Spectrum> means_of_groups(std::size_t groups, std::span<const LeafResidual> samples) {
    constexpr double prior_samples = 4;  // additional samples per group that have no residual
    std::vector<Spectrum> out(groups);
    std::vector<double> count(groups, prior_samples);
    for (const LeafResidual& s : samples) out[s.group] += s.weight * s.residual, count[s.group] += s.weight;
    for (std::size_t g = 0; g < groups; ++g) out[g] = out[g] / count[g];
    return out;
}

/// Returns the elements on the path from the root to a leaf.
std::vector<ElementId> path_to(const ElementTree& tree, ElementId leaf) {
    std::vector<ElementId> out;
    for (ElementId e = leaf; !e.is_none(); e = tree.parent(e)) out.push_back(e);
    std::reverse(out.begin(), out.end());
    return out;
}

}  // namespace

std::vector<Spectrum> mean_residuals(const ElementTree& tree, const LeafNumbering& numbering,
                                     std::span<const std::uint32_t> group_of_leaf, std::size_t groups,
                                     std::span<const LeafResidual> samples) {
    const std::vector<Spectrum> of_group = means_of_groups(groups, samples);
    std::vector<std::vector<ElementId>> paths;
    std::vector<Spectrum> known;  // per sample: mean of the smallest element on its path that is already estimated
    std::size_t depth = 0;
    for (const LeafResidual& s : samples) {
        depth = std::max(depth, paths.emplace_back(path_to(tree, numbering.leaves[s.leaf])).size());
        known.push_back(of_group[s.group]);
    }
    // For each level, finds the elements that contain samples, and how far each one's mean deviates from its parent's.
    constexpr std::uint32_t none = 0xffffffffu;
    Field<ElementId, std::uint32_t> place(tree.size(), none);
    std::vector<Beyond> met;
    std::vector<Spectrum> beyond;
    for (std::size_t level = 0; level < depth; ++level) {
        const std::size_t first = met.size();
        for (std::size_t k = 0; k < samples.size(); ++k) {
            if (level >= paths[k].size()) continue;
            std::uint32_t& at = place[paths[k][level]];
            if (at == none) at = static_cast<std::uint32_t>(met.size()), met.emplace_back();
            met[at].add(samples[k].weight, samples[k].residual - known[k]);
        }
        Agreement agreement;
        for (std::size_t i = first; i < met.size(); ++i) agreement.count(met[i]);
        for (std::size_t i = first; i < met.size(); ++i) beyond.push_back(agreement.drawn(met[i]));
        for (std::size_t k = 0; k < samples.size(); ++k)
            if (level < paths[k].size()) known[k] += beyond[place[paths[k][level]]];
    }
    std::vector<Spectrum> out(numbering.leaves.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = of_group[group_of_leaf[i]];
        for (ElementId e = numbering.leaves[i]; !e.is_none(); e = tree.parent(e))
            if (place[e] != none) out[i] += beyond[place[e]];
    }
    return out;
}

}  // namespace exitance
