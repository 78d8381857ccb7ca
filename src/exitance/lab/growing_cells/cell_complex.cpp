#include "exitance/lab/growing_cells/cell_complex.hpp"

#include <algorithm>
#include <set>

#include "exitance/base/check.hpp"

namespace exitance {

CellComplex::CellComplex(std::size_t k) : k_(k) {
    EXI_CHECK(k >= 1 && k <= largest_dimension);
    incident_.resize(k + 1), neighbours_.resize(k + 1);
    Simplex first;
    first.fill(none);
    for (std::size_t i = 0; i <= k; ++i) first[i] = static_cast<Unit>(i);
    add_simplex(first);
    alive_units_ = k + 1;
    for (Unit u = 0; u <= k; ++u) find_neighbours(u);
}

std::uint32_t CellComplex::add_simplex(const Simplex& simplex) {
    std::uint32_t s;
    if (free_.empty()) {
        s = static_cast<std::uint32_t>(simplices_.size());
        simplices_.push_back(simplex);
    } else {
        s = free_.back();
        free_.pop_back();
        simplices_[s] = simplex;
    }
    std::sort(simplices_[s].begin(), simplices_[s].begin() + static_cast<std::ptrdiff_t>(k_ + 1));
    for (std::size_t i = 0; i <= k_; ++i) {
        auto& list = incident_[simplices_[s][i]];
        list.insert(std::upper_bound(list.begin(), list.end(), s), s);
    }
    ++alive_simplices_;
    return s;
}

void CellComplex::remove_simplex(std::uint32_t s) {
    for (std::size_t i = 0; i <= k_; ++i) {
        auto& list = incident_[simplices_[s][i]];
        list.erase(std::lower_bound(list.begin(), list.end(), s));
    }
    simplices_[s].fill(none);
    free_.push_back(s);
    --alive_simplices_;
}

void CellComplex::find_neighbours(Unit u) {
    std::vector<Unit>& out = neighbours_[u];
    out.clear();
    for (const std::uint32_t s : incident_[u])
        out.insert(out.end(), simplices_[s].begin(), simplices_[s].begin() + static_cast<std::ptrdiff_t>(k_ + 1));
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    out.erase(std::remove(out.begin(), out.end(), u), out.end());
}

bool CellComplex::holds(std::uint32_t s, Unit u) const {
    return std::find(simplices_[s].begin(), simplices_[s].begin() + static_cast<std::ptrdiff_t>(k_ + 1), u) !=
           simplices_[s].begin() + static_cast<std::ptrdiff_t>(k_ + 1);
}

std::size_t CellComplex::simplices_of_edge(Unit a, Unit b) const {
    std::size_t count = 0;
    for (const std::uint32_t s : incident_[a]) count += holds(s, b);
    return count;
}

CellComplex::Unit CellComplex::split_edge(Unit a, Unit b) {
    const auto middle = static_cast<Unit>(incident_.size());
    incident_.emplace_back(), neighbours_.emplace_back();
    std::vector<Simplex> cut;
    for (const std::uint32_t s : std::vector<std::uint32_t>(incident_[a]))
        if (holds(s, b)) cut.push_back(simplices_[s]), remove_simplex(s);
    EXI_CHECK(!cut.empty());  // an edge belongs to a simplex
    for (const Simplex& whole : cut)
        for (const Unit end : {a, b}) {
            Simplex half = whole;
            *std::find(half.begin(), half.end(), end) = middle;
            add_simplex(half);
        }
    ++alive_units_;
    find_neighbours(middle);
    for (const Unit u : neighbours_[middle]) find_neighbours(u);
    return middle;
}

std::vector<CellComplex::Unit> CellComplex::remove(Unit u) {
    if (incident_[u].size() == alive_simplices_) return {};
    std::vector<Unit> around = neighbours_[u], gone{u};
    for (const std::uint32_t s : std::vector<std::uint32_t>(incident_[u])) remove_simplex(s);
    neighbours_[u].clear();
    for (const Unit c : around) {
        find_neighbours(c);
        if (incident_[c].empty()) gone.push_back(c);
    }
    alive_units_ -= gone.size();
    return gone;
}

std::vector<CellComplex::Unit> CellComplex::simplices() const {
    std::vector<Unit> out;
    out.reserve(alive_simplices_ * (k_ + 1));
    for (const Simplex& s : simplices_)
        if (s[0] != none) out.insert(out.end(), s.begin(), s.begin() + static_cast<std::ptrdiff_t>(k_ + 1));
    return out;
}

bool CellComplex::is_valid() const {
    std::set<Simplex> seen;
    std::size_t alive = 0, units = 0;
    for (std::uint32_t s = 0; s < simplices_.size(); ++s) {
        const Simplex& simplex = simplices_[s];
        if (simplex[0] == none) continue;
        ++alive;
        if (!seen.insert(simplex).second) return false;
        for (std::size_t i = 0; i <= k_; ++i) {
            if (simplex[i] >= incident_.size() || (i > 0 && simplex[i] <= simplex[i - 1])) return false;
            const auto& list = incident_[simplex[i]];
            if (!std::binary_search(list.begin(), list.end(), s)) return false;
        }
    }
    for (Unit u = 0; u < incident_.size(); ++u) {
        units += !incident_[u].empty();
        for (const std::uint32_t s : incident_[u])
            if (!holds(s, u)) return false;
        for (const Unit v : neighbours_[u])
            if (simplices_of_edge(u, v) == 0) return false;
        CellComplex copy = *this;
        if (unit_end() < 64) {  // for small complexes, recompute the lists
            copy.find_neighbours(u);
            if (copy.neighbours_[u] != neighbours_[u]) return false;
        }
    }
    return alive == alive_simplices_ && units == alive_units_;
}

std::size_t CellComplex::component_count() const {
    std::vector<std::uint8_t> seen(unit_end(), 0);
    std::vector<Unit> open;
    std::size_t count = 0;
    for (Unit first = 0; first < unit_end(); ++first) {
        if (seen[first] || !has_unit(first)) continue;
        ++count;
        open.push_back(first), seen[first] = 1;
        while (!open.empty()) {
            const Unit u = open.back();
            open.pop_back();
            for (const Unit v : neighbours_[u])
                if (!seen[v]) seen[v] = 1, open.push_back(v);
        }
    }
    return count;
}

}  // namespace exitance
