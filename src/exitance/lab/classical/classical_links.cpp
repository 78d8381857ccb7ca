#include <fmt/format.h>

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/lab/classical/classical.hpp"
#include "exitance/lab/classical/interaction_kernel.hpp"
#include "exitance/lab/classical/kernel_oracle.hpp"
#include "exitance/mesh/element_tree_archive.hpp"
#include "exitance/solve/growth_watch.hpp"

namespace exitance {
namespace {

constexpr std::size_t default_memory = std::size_t(1) << 32;  // limit on the memory of links, bytes
constexpr double rounding = 1e-6;                             // relative rounding of lengths and areas in files
constexpr std::size_t max_rounds = 200;                       // limit on rounds of refinement and gathering

/// Returns how to cut an element: into quarters, or across its length if a parallelogram is much longer than wide, so
/// that elements become about as long as wide.
Cut cut_kind(const Patch& patch) {
    constexpr double long_ratio = 1.5;
    const double a = norm(patch.a), b = norm(patch.b);
    if (patch.is_triangle() || std::max(a, b) <= (1 + rounding) * long_ratio * std::min(a, b)) return Cut::both;
    return a > b ? Cut::u : Cut::v;
}

struct Link {
    ElementId source;
    float share = 1;  ///< Visible share of the source.
    bool has_block = false;
    /// Strength of the link per exitance of the source by the kernel oracle, m^2; negative: not computed.
    float kernel_strength = -1;
    std::uint64_t block = 0;  ///< Position of the link's block in `blocks_`.
};

/// Coefficients of all elements, one per node.
class Numbers {
  public:
    explicit Numbers(std::size_t nodes) : n_(nodes) {}
    void resize(std::size_t elements) { values_.resize(elements * n_); }
    std::span<Spectrum> operator[](ElementId e) { return std::span(values_).subspan(e.value * n_, n_); }
    std::span<const Spectrum> operator[](ElementId e) const { return std::span(values_).subspan(e.value * n_, n_); }
    void clear() { std::fill(values_.begin(), values_.end(), Spectrum()); }
    std::size_t memory_bytes() const { return values_.size() * sizeof(Spectrum); }
    template <class Archive>
    friend void archive(Archive& a, Numbers& numbers) {
        a(numbers.values_);
    }

  private:
    std::size_t n_;
    std::vector<Spectrum> values_;
};

/// Elements, their coefficients, and the links over which each element gathers.
class LinkedElements {
  public:
    LinkedElements(const MethodInput& input, HierarchyBasis kind)
        : input_(input),
          basis_(kind),
          kernel_(input.stage, basis_, choice(input), input.options.seed),
          oracle_(basis_),
          n_(basis_.count()),
          B_(n_),
          E_(n_),
          rhs_(n_) {
        for (const auto& [region, patch] : input.stage.pieces) tree_.add_root(region, patch);
        grow();
        for (ElementId e : tree_.roots()) set_light(e);
        B_ = rhs_;
        const double whole = input.stage.area;
        min_area_ = input.options.min_area.value_or(by_oracle() ? default_min_share * whole : 0);
        longest_edge_ = by_oracle() ? input.options.mesh_size.value_or(0) : input.knobs.solve_mesh.edge;
    }

    void link_roots();
    /// Splits links that are too strong. Returns true if any was split.
    bool refine(double threshold);
    /// Gathers E = F b over the links, pushes it down to the leaves and pulls b up. Returns the relative change of b.
    double gather();

    bool by_oracle() const { return input_.options.classical.threshold.has_value(); }
    void report(GlobalLight& light) const;
    ElementFunction irradiance() const;
    bool out_of_memory() const { return out_of_memory_; }
    /// Archives everything that rounds change.
    template <class Archive>
    void archive_state(Archive& a) {
        a(tree_, B_, E_, rhs_, blocks_, free_, initial_links_, link_count_, rays_, form_factors_, out_of_memory_);
        a(work_.rays);
        links_.resize(tree_.size());
        for (ElementId e : tree_.ids()) a(links_[e]);
    }

  private:
    static KernelChoice choice(const MethodInput& input) {
        const SolveOptions& o = input.options;
        return {.kernel = input.options.classical.kernel.value_or(TransferKernel::exact),
                .visibility = o.visibility,
                .rays = static_cast<unsigned>(std::min<std::size_t>(4096, o.visibility_samples.value_or(16)))};
    }
    void grow() {
        B_.resize(tree_.size()), E_.resize(tree_.size()), rhs_.resize(tree_.size());
        links_.resize(tree_.size());
    }
    void set_light(ElementId e);
    bool may_cut(ElementId e) const;
    void cut(ElementId e);
    double brightest(ElementId source) const;
    double strength(ElementId receiver, Link& link) const;
    ElementId to_cut(ElementId receiver, Link& link, double threshold) const;
    bool settle(ElementId receiver, Link link, double threshold);
    void look(ElementId receiver, Link& link);
    void keep(ElementId receiver, const Link& link);
    void make_blocks();

    const MethodInput& input_;
    NodalBasis basis_;
    InteractionKernel kernel_;
    KernelOracle oracle_;
    std::size_t n_;
    ElementTree tree_;
    Numbers B_, E_, rhs_;                        ///< b; irradiance; source term M or rho E_dir.
    Field<ElementId, std::vector<Link>> links_;  ///< Per receiver.
    std::vector<float> blocks_;
    std::vector<std::uint64_t> free_;  ///< Blocks of links that were split, for reuse.
    InteractionKernel::Workspace work_;
    std::size_t initial_links_ = 0, link_count_ = 0, rays_ = 0, form_factors_ = 0;
    /// Limits of refinement: area (m^2) below which and edge (m) up to which elements are not cut.
    double min_area_ = 0, longest_edge_ = 0;
    bool out_of_memory_ = false;
};

/// Computes the source term of an element: M, or rho E_dir at its nodes.
void LinkedElements::set_light(ElementId e) {
    const Material& material = material_of(input_, tree_, e);
    if (carries_light(input_)) {
        for (Spectrum& value : rhs_[e]) value = material.exitance;
        return;
    }
    const Patch& patch = tree_.patch(e);
    const auto nodes = basis_.nodes(patch.shape);
    DirectLight::Workspace scratch;
    for (std::size_t k = 0; k < n_; ++k)
        rhs_[e][k] = material.reflectance *
                     input_.stage.direct.irradiance(patch.at(nodes[k].at), patch.normal(), tree_.region(e), scratch);
}

bool LinkedElements::may_cut(ElementId e) const {
    if (!tree_.is_leaf(e)) return true;
    const Patch& patch = tree_.patch(e);
    if (patch.area() / (cut_kind(patch) == Cut::both ? 4 : 2) < min_area_) return false;
    const double edge = std::max({norm(patch.a), norm(patch.b), patch.is_triangle() ? norm(patch.a - patch.b) : 0.0});
    return edge > longest_edge_ * (1 + rounding);
}

/// Cuts an element. Its children start with their parent's light.
void LinkedElements::cut(ElementId e) {
    if (!tree_.is_leaf(e)) return;
    tree_.split(e, cut_kind(tree_.patch(e)));
    grow();
    std::size_t i = 0;
    for (ElementId child : tree_.children(e)) {
        const auto push = basis_.push(tree_.patch(e).shape, tree_.cut_of(e), i++);
        set_light(child);
        for (std::size_t k = 0; k < n_; ++k) {
            Spectrum b = rhs_[child][k];
            for (std::size_t j = 0; j < n_; ++j) b += push[k * n_ + j] * (B_[e][j] - rhs_[e][j]);
            B_[child][k] = b;
        }
    }
}

/// Mean exitance of an element in the brightest band, W/m^2.
double LinkedElements::brightest(ElementId source) const {
    const auto nodes = basis_.nodes(tree_.patch(source).shape);
    Spectrum B;
    for (std::size_t k = 0; k < n_; ++k) B += nodes[k].weight * B_[source][k];
    return max(B);
}

/// Strength of a link. F_eps: the larger form factor of both directions. BF_eps: F_pq A_p B_q, W in the brightest band
/// [Hanrahan91]. Kernel: the power that the interpolated kernel may miss, W likewise [Gortler93].
double LinkedElements::strength(ElementId receiver, Link& link) const {
    const ElementId source = link.source;
    if (input_.options.classical.oracle == ClassicalOracle::kernel) {
        if (link.kernel_strength < 0)
            link.kernel_strength =
                static_cast<float>(oracle_.strength(tree_.patch(receiver), tree_.patch(source), link.share));
        return static_cast<double>(link.kernel_strength) * brightest(source);
    }
    // Estimated from either centre: by reciprocity both should be equal, but each misses parts near an end of the
    // other.
    const double F = std::max(kernel_.unoccluded(tree_, receiver, source),
                              kernel_.unoccluded(tree_, source, receiver) * tree_.area(source) / tree_.area(receiver));
    if (input_.options.oracle == LinkOracle::form_factor)
        return std::max(F, F * tree_.area(receiver) / tree_.area(source));
    return F * tree_.area(receiver) * brightest(source);
}

/// Returns the element to cut, or none: the larger one unless it is too small to be cut, then the smaller one. The
/// strength by the kernel contains visibility; the other oracles halve the threshold of partly visible sources.
ElementId LinkedElements::to_cut(ElementId p, Link& link, double threshold) const {
    const ElementId q = link.source;
    if (by_oracle()) {
        const bool partial =
            link.share > 0 && link.share < 1 && input_.options.classical.oracle != ClassicalOracle::kernel;
        if (strength(p, link) <= (partial ? 0.5 * threshold : threshold)) return {};
    }
    const bool first = tree_.area(p) >= (1 - rounding) * tree_.area(q) && tree_.area(p) > 0;
    const ElementId larger = first ? p : q, smaller = first ? q : p;
    return may_cut(larger) ? larger : may_cut(smaller) ? smaller : ElementId();
}

void LinkedElements::look(ElementId p, Link& link) {
    link.share = static_cast<float>(kernel_.visible_share(tree_, p, link.source, work_));
}

/// Drops a link that no ray found visible, unless triage is off or visibility is exact.
void LinkedElements::keep(ElementId p, const Link& link) {
    const bool sure = input_.options.triage && input_.options.visibility != VisibilityKind::exact;
    if (link.share == 0 && sure) return;
    links_[p].push_back(link), ++link_count_;
}

/// Splits a link until none of its parts is too strong, and keeps these. Returns true if it was split. With an oracle,
/// visibility is sampled for every link, but not below a link whose rays are all unblocked. Without an oracle, only
/// links between leaves are sampled.
bool LinkedElements::settle(ElementId p, Link link, double threshold) {
    const bool hidden = by_oracle() && link.share == 0 && input_.options.triage;
    const ElementId e = hidden ? ElementId() : to_cut(p, link, threshold);
    const std::size_t limit = input_.options.memory_limit_bytes.value_or(default_memory);
    out_of_memory_ |= link_count_ * (n_ * n_ * sizeof(float) + sizeof(Link)) > limit;
    if (e.is_none() || out_of_memory_ || input_.stop.requested()) {
        if (!by_oracle() && !link.has_block) look(p, link);
        keep(p, link);
        return false;
    }
    if (link.has_block) free_.push_back(link.block);
    cut(e);
    for (ElementId child : tree_.children(e)) {
        Link finer{.source = e == p ? link.source : child};
        const ElementId receiver = e == p ? child : p;
        if (!kernel_.faces(tree_, receiver, finer.source)) continue;
        if (by_oracle() && (link.share < 1 || !input_.options.triage)) look(receiver, finer);
        settle(receiver, finer, threshold);
    }
    return true;
}

void LinkedElements::link_roots() {
    const std::vector<ElementId> roots = tree_.roots();
    for (ElementId p : roots)
        for (ElementId q : roots) {
            Link link{.source = q};
            if (p == q || !kernel_.faces(tree_, p, q)) continue;
            if (by_oracle()) look(p, link);
            keep(p, link);
        }
    initial_links_ = link_count_;
}

bool LinkedElements::refine(double threshold) {
    bool cut_any = false;
    const std::size_t before = tree_.size();  // elements that are made below need no further step
    for (std::uint32_t i = 0; i < before && !input_.stop.requested(); ++i) {
        const ElementId p(i);
        const std::vector<Link> own = std::exchange(links_[p], {});
        link_count_ -= own.size();
        for (const Link& link : own) cut_any |= settle(p, link, threshold);
    }
    make_blocks();
    return cut_any;
}

void LinkedElements::make_blocks() {
    const std::size_t size = n_ * n_;
    struct Job {
        ElementId receiver;
        Link* link;
    };
    std::vector<Job> jobs;
    for (ElementId p : tree_.ids())
        for (Link& link : links_[p]) {
            if (link.has_block) continue;
            if (free_.empty()) {
                link.block = blocks_.size();
                blocks_.resize(blocks_.size() + size);
            } else {
                link.block = free_.back();
                free_.pop_back();
            }
            link.has_block = true;
            jobs.push_back({p, &link});
        }
    constexpr std::size_t grain = 64;
    std::vector<std::pair<std::size_t, std::size_t>> counts((jobs.size() + grain - 1) / grain);
    parallel_for(counts.size(), 1, [&](std::size_t b) {
        InteractionKernel::Workspace w;
        for (std::size_t i = b * grain; i < std::min(jobs.size(), (b + 1) * grain); ++i)
            kernel_.block(tree_, jobs[i].receiver, jobs[i].link->source, jobs[i].link->share,
                          std::span(blocks_).subspan(jobs[i].link->block, size), w);
        counts[b] = {w.rays, w.form_factors};
    });
    for (const auto& [rays, factors] : counts) rays_ += rays, form_factors_ += factors;
}

double LinkedElements::gather() {
    parallel_for(tree_.size(), 64, [&](std::size_t i) {
        const ElementId p(i);
        for (Spectrum& value : E_[p]) value = {};
        for (const Link& link : links_[p]) {
            const float* K = &blocks_[link.block];
            for (std::size_t k = 0; k < n_; ++k)
                for (std::size_t l = 0; l < n_; ++l)
                    E_[p][k] += static_cast<double>(K[k * n_ + l]) * B_[link.source][l];
        }
    });
    for (ElementId p : tree_.ids()) {  // push
        std::size_t i = 0;
        for (ElementId child : tree_.children(p)) {
            const auto push = basis_.push(tree_.patch(p).shape, tree_.cut_of(p), i++);
            for (std::size_t k = 0; k < n_; ++k)
                for (std::size_t j = 0; j < n_; ++j) E_[child][k] += push[k * n_ + j] * E_[p][j];
        }
    }
    double change = 0, scale = 0;
    for (std::size_t i = tree_.size(); i-- > 0;) {  // reflect, pull
        const ElementId p(i);
        if (tree_.is_leaf(p)) {
            const Spectrum rho = material_of(input_, tree_, p).reflectance;
            const auto nodes = basis_.nodes(tree_.patch(p).shape);
            for (std::size_t k = 0; k < n_; ++k) {
                const Spectrum b = rhs_[p][k] + rho * E_[p][k];
                const double weight = tree_.area(p) * nodes[k].weight;
                change += weight * squared(b - B_[p][k]), scale += weight * squared(rhs_[p][k]);
                B_[p][k] = b;
            }
            continue;
        }
        std::vector<Spectrum> b(n_);
        std::size_t c = 0;
        for (ElementId child : tree_.children(p)) {
            const auto pull = basis_.pull(tree_.patch(p).shape, tree_.cut_of(p), c++);
            for (std::size_t j = 0; j < n_; ++j)
                for (std::size_t k = 0; k < n_; ++k) b[j] += pull[j * n_ + k] * B_[child][k];
        }
        std::copy(b.begin(), b.end(), B_[p].begin());
    }
    return scale > 0 ? std::sqrt(change / scale) : 0;
}

/// Returns the elements' polynomials; flatlets as the multiwavelets of their order [Willmott97]. Quadratic ones are
/// sampled on 4 x 4 cells that are (bi)linear.
ElementFunction LinkedElements::irradiance() const {
    ElementFunction out;
    out.tree = tree_;
    const std::vector<ElementId> leaves = tree_.leaves();
    std::vector<std::pair<ElementId, ElementId>> cells;  // pairs of a leaf and one of its cells
    for (ElementId leaf : leaves) {
        if (basis_.order() < 3) {
            cells.push_back({leaf, leaf});
            continue;
        }
        out.tree.split(leaf, Cut::both);
        const auto quarters = out.tree.children(leaf);
        for (ElementId quarter : quarters) {
            out.tree.split(quarter, Cut::both);
            for (ElementId cell : out.tree.children(quarter)) cells.push_back({leaf, cell});
        }
    }
    out.first_value.resize(out.tree.size(), 0);
    std::vector<double> factors(n_);
    for (const auto& [leaf, cell] : cells) {
        out.first_value[cell] = static_cast<std::uint32_t>(out.values.size());
        const Patch &whole = tree_.patch(leaf), &part = out.tree.patch(cell);
        for (int i = 0; i < part.corner_count(); ++i) {
            basis_.interpolate(whole.shape, whole.coordinates(part.corner(i)), factors);
            Spectrum E;
            for (std::size_t k = 0; k < n_; ++k) E += factors[k] * E_[leaf][k];
            out.add_value(E);
        }
    }
    return out;
}

void LinkedElements::report(GlobalLight& light) const {
    light.published->irradiance = irradiance();
    light.published->elements = tree_.size(), light.published->leaf_elements = tree_.leaves().size();
    light.work.links = link_count_, light.published->figures["initial_links"] = static_cast<double>(initial_links_);
    light.work.rays = rays_ + work_.rays, light.work.form_factors = form_factors_;
    light.work.link_memory_bytes = link_count_ * (sizeof(Link) + n_ * n_ * sizeof(float));
    light.published->figures["coefficient_memory_bytes"] =
        static_cast<double>(B_.memory_bytes() + E_.memory_bytes() + rhs_.memory_bytes());
}

HierarchyBasis basis_of(const SolveOptions& options) {
    switch (options.basis.value_or(BasisKind::multiwavelet2)) {
        case BasisKind::haar:
            return HierarchyBasis::haar;
        case BasisKind::flatlet2:
            return HierarchyBasis::flatlet2;
        case BasisKind::flatlet3:
            return HierarchyBasis::flatlet3;
        case BasisKind::multiwavelet3:
            return HierarchyBasis::multiwavelet3;
        default:
            return HierarchyBasis::multiwavelet2;
    }
}

/// Hierarchical and wavelet radiosity as in [Hanrahan91] and [Gortler93]. Starting from whole polygons, links are split
/// while their strength by the oracle is above a threshold and elements are larger than A_eps; the threshold is halved
/// for partial visibility. Light is gathered over links, pushed and pulled. This is repeated with the new light until
/// no link is split and the change is small. With `--multigrid N`, the first threshold is 2^(N-1) times as large and is
/// halved in each round. Without an oracle, all links connect leaves of `--mesh-size`: a uniform mesh, O(leaves^2).
GlobalLight solve_over_classical_links(const MethodInput& input, HierarchyBasis kind) {
    GlobalLight light = published_light(input);
    input.progress.phase("link");
    LinkedElements elements(input, kind);
    elements.link_roots();
    const std::size_t grids = input.options.classical.multigrid.value_or(1);
    std::size_t grid = 1;
    double change = 1;
    std::size_t round = 0;
    SafePoints safe_points = input.safe_points;
    const auto state = [&](auto& a) {
        a(grid, round, light.report.iterations);
        elements.archive_state(a);
    };
    safe_points.resume(state);
    for (; round < max_rounds + input.knobs.max_iterations; ++round) {
        safe_points.pass(state);
        const double coarser = std::exp2(static_cast<double>(grids - std::min(grid, grids)));
        const bool cut = round < max_rounds && elements.refine(coarser * input.options.classical.threshold.value_or(0));
        change = elements.gather();
        ++light.report.iterations;
        input.end_round([&] {
            GlobalLight so_far = light;
            elements.report(so_far);
            return so_far;
        });
        light.report.interrupted = input.stop.requested();
        if (light.report.interrupted || !(change < diverged_residual) || elements.out_of_memory()) break;
        if (input.options.max_iterations && light.report.iterations >= *input.options.max_iterations) break;
        if (cut || change > input.knobs.residual) continue;
        if (grid >= grids) break;
        ++grid;
    }
    light.report.residual = change;
    light.report.converged = !light.report.interrupted && change <= input.knobs.residual;
    light.limited_by_memory = elements.out_of_memory();
    elements.report(light);
    return light;
}

}  // namespace

GlobalLight solve_classical_hierarchical(const MethodInput& input) {
    return solve_over_classical_links(input, HierarchyBasis::haar);
}

GlobalLight solve_classical_wavelet(const MethodInput& input) {
    return solve_over_classical_links(input, basis_of(input.options));
}

}  // namespace exitance
