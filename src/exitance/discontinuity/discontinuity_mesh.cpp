#include "exitance/discontinuity/discontinuity_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/discontinuity/clough_tocher_fit.hpp"
#include "exitance/discontinuity/exact_places.hpp"
#include "exitance/discontinuity/face_lights.hpp"
#include "exitance/discontinuity/findable.hpp"
#include "exitance/discontinuity/finished_mesh.hpp"
#include "exitance/discontinuity/mesh_limits.hpp"
#include "exitance/discontinuity/mesh_progress.hpp"
#include "exitance/discontinuity/misfit.hpp"
#include "exitance/discontinuity/node_values.hpp"
#include "exitance/discontinuity/shadow_class.hpp"
#include "exitance/mesh/discontinuity/bisection_mesh.hpp"
#include "exitance/scene/named_regions.hpp"
#include "exitance/transport/direct_projection.hpp"

namespace exitance {
namespace {

class Builder {
  public:
    Builder(const Stage& stage, const DiscontinuityOptions& options, DiscontinuityReport& report,
            const StopRequest& stop)
        : stage_(stage),
          options_(options),
          report_(report),
          stop_(stop),
          mesh_(mesh_limits::shortest_edge * stage.scene.size()),
          touched_(stage.scene.regions().size(), 0) {}

    SixNodeMesh run() {
        Stopwatch watch;
        if (options_.lines.kind == ShadowLines::Kind::on_surfaces)
            followed_ = regions_named(stage_.scene, options_.lines.names);
        resume();
        look_ahead();
        find_weak_light();
        report_.direct_seconds += watch.restart();
        if (!stop_.requested()) find_curves();
        report_.mesh_seconds += watch.restart();
        report_.interrupted = stop_.requested();
        if (report_.interrupted) return {};
        constexpr int max_attempts = 5;
        double tolerance = calibrated::part_aim * options_.error * report_.scale;
        SixNodeMesh out;
        for (int attempt = 1;; ++attempt) {
            refine(tolerance);
            report_.direct_seconds += watch.restart();
            report_.interrupted = stop_.requested();
            if (!is_lit_) return {};
            out = finish();
            report_.error = report_.scale > 0 ? error_at_places(out) / report_.scale : 0;
            report_.mesh_seconds += watch.restart();
            report_.interrupted = stop_.requested();
            if (report_.error <= options_.error || attempt == max_attempts || report_.interrupted || is_full()) break;
            tolerance *= calibrated::attempt_aim * options_.error / report_.error;
        }
        out.shadow = shadow_classes();
        report_.direct_seconds += watch.restart();
        return out;
    }

  private:
    Spectrum weight(RegionId r) const { return places_->weight(r); }

    void look_ahead() {
        places_.emplace(stage_, options_.direct_weight, options_.indirect, options_.seed, stop_);
        report_.scale = options_.scale > 0 ? options_.scale : places_->mean_light();
        largest_ = options_.scale > 0 ? options_.brightest : places_->largest_light();
        area_ = places_->area();
    }

    /// If there are many emitters, most contribute little to any region: weak ones are estimated by rays.
    void find_weak_light() {
        if (options_.search) search_ = options_.search(stage_.direct);
        const bool exact_everywhere = options_.lines.kind == ShadowLines::Kind::all;
        if (stop_.requested() || search_ || exact_everywhere || !WeakLight::pays(stage_.direct)) return;
        // Regions below the average area may have more noise, since the refinement criterion permits triangles there
        // more error.
        constexpr double part = mesh_limits::ray_noise;
        const double rms = calibrated::part_aim * options_.error * report_.scale,
                     largest_error = options_.largest_error * largest_;
        const auto regions = static_cast<double>(stage_.scene.regions().size());
        weak_.emplace(stage_.direct, stage_.tracer,
                      WeakLight::Asked{mesh_limits::unseen_light * std::min(rms, largest_error), part * rms,
                                       part * largest_error, area_ / regions, &followed_},
                      stop_);
    }

    /// Loads the curves and node values of an earlier run, if there are any.
    void resume() {
        if (!options_.safe_points) return;
        const std::size_t regions = stage_.scene.regions().size();
        options_.safe_points->resume([&](ArchiveReader& a) { a(found_); });
        if (found_.receivers.size() != regions) found_ = {};
        found_.receivers.resize(regions);
        for (const FoundCurves& found : found_.receivers) report_.resumed_receivers += found.is_done;
        report_.resumed_nodes = found_.values.size();
        values_.resume(std::move(found_.values));
    }

    void keep() {
        if (!options_.safe_points) return;
        options_.safe_points->pass([&](ArchiveWriter& a) {
            std::vector<Spectrum> values = values_.in_order();
            a(found_.receivers, values);
        });
    }

    ReceiverCurves curves_of(const CurveFinder& finder, std::uint32_t number) {
        const RegionId region(number);
        if (!found_.receivers.empty() && found_.receivers[number].is_done) {
            const FoundCurves& found = found_.receivers[number];
            ReceiverCurves out = finder.look(region);
            out.loops = found.loops, out.curves = found.curves;
            out.wedges = found.wedges, out.left_out = found.left_out;
            return out;
        }
        ReceiverCurves out = finder.find(region);
        if (options_.indirect) finder.add_contacts_in_the_dark(region, out);
        if (!found_.receivers.empty() && !stop_.requested())
            found_.receivers[number] = {true, out.loops, out.curves, out.wedges, out.left_out};
        return out;
    }

    CurveOptions curve_options() const {
        CurveOptions out{.conics = options_.conics,
                         .secondary = options_.secondary,
                         .stop = &stop_,
                         .weak = weak_ ? &*weak_ : nullptr,
                         .search = search_.get()};
        if (followed_.size() > 0) out.regions = &followed_;
        if (follows_all()) {
            out.max_curves = out.max_edges = SIZE_MAX;
            return out;
        }
        const double T = options_.largest_error * largest_;
        out.min_effect = (weak_ ? mesh_limits::min_kink_among_many : mesh_limits::min_kink) * T;
        out.min_area = mesh_limits::unfindable_area * area_;
        out.min_bend = (weak_ ? mesh_limits::min_bend_among_many : mesh_limits::min_bend) * T;
        out.min_narrow_bend = weak_ ? HUGE_VAL : T;
        return out;
    }

    /// True if curves are followed however little light they change.
    bool follows_all() const {
        return options_.lines.kind == ShadowLines::Kind::all || options_.lines.kind == ShadowLines::Kind::on_surfaces;
    }

    /// Keeps the curves with the largest gain times length, and all contacts, if the number of curves is limited.
    void keep_strongest(std::span<std::optional<ReceiverCurves>> receivers) const {
        if (options_.lines.kind != ShadowLines::Kind::strongest) return;
        const auto is_contact = [](const FlatCurve& c) { return c.cause == CurveCause::contact; };
        std::vector<double> effects;
        for (const auto& receiver : receivers)
            for (const FlatCurve& c : receiver->curves)
                if (!is_contact(c)) effects.push_back(c.effect());
        if (effects.size() <= options_.lines.count) return;
        std::sort(effects.begin(), effects.end(), std::greater<>());
        // The first ones of several curves with the same effect are kept.
        const double least = options_.lines.count > 0 ? effects[options_.lines.count - 1] : HUGE_VAL;
        const auto above = std::count_if(effects.begin(), effects.end(), [&](double e) { return e > least; });
        std::size_t equal = options_.lines.count - static_cast<std::size_t>(above);
        for (auto& receiver : receivers)
            receiver->left_out += std::erase_if(receiver->curves, [&](const FlatCurve& c) {
                if (is_contact(c) || c.effect() > least) return false;
                if (c.effect() < least || equal == 0) return true;
                return --equal, false;
            });
    }

    ReceiverTriangles triangles_of(const ReceiverCurves& receiver) const {
        if (options_.cutter)
            if (auto cut = options_.cutter(receiver, mesh_limits::one_place * stage_.scene.size()))
                return std::move(*cut);
        return receiver_triangles(receiver, options_.refined);
    }

    void find_curves() {
        const BlockerEdges edges(stage_.occluders);
        const CurveFinder finder(stage_, edges, curve_options());
        const std::size_t regions = stage_.scene.regions().size();
        std::vector<std::optional<ReceiverCurves>> receivers(regions);
        std::vector<ReceiverTriangles> triangles(regions);
        // With checkpoints, receivers are processed in batches so that progress is saved between them.
        const std::size_t batch = options_.safe_points ? 256 : regions;
        for (std::size_t first = 0; first < regions && !stop_.requested(); first += batch) {
            parallel_for(std::min(batch, regions - first), 1, [&](std::size_t k) {
                if (stop_.requested()) return;
                receivers[first + k].emplace(curves_of(finder, static_cast<std::uint32_t>(first + k)));
            });
            keep();
        }
        if (stop_.requested()) return;
        keep_strongest(receivers);
        parallel_for(regions, 1, [&](std::size_t r) {
            if (!stop_.requested()) triangles[r] = triangles_of(*receivers[r]);
        });
        if (stop_.requested()) return;
        std::vector<std::size_t> first_face{0};
        for (const RegionId r : stage_.scene.regions().ids()) {
            ReceiverCurves& receiver = *receivers[r.value];
            mesh_.add(triangles[r.value].triangles, receiver.frame);
            report_.tree_bytes += triangles[r.value].tree_bytes;
            region_.resize(mesh_.triangles().size(), r), first_face.push_back(region_.size());
            record(r, receiver);
        }
        look_at_faces(receivers, first_face);
        count_faces(receivers);
    }

    /// Finds the sources and candidate blockers of every face of each receiver.
    void look_at_faces(std::vector<std::optional<ReceiverCurves>>& receivers, std::span<const std::size_t> first_face) {
        lights_.resize(region_.size());
        parallel_for(receivers.size(), 1, [&](std::size_t r) {
            FaceOutlines outlines{{}, receivers[r]->frame.u, receivers[r]->frame.v};
            const std::size_t first = first_face[r], count = first_face[r + 1] - first;
            for (std::size_t f = first; f < first + count; ++f)
                outlines.faces.push_back(inner_outline(static_cast<std::uint32_t>(f)));
            DirectLight::Workspace workspace;
            const RegionId region(r);
            if (weak_)  // searching from scratch is cheaper than filtering all blockers of the region
                for (std::size_t f = 0; f < count && !stop_.requested(); ++f)
                    stage_.direct.prepare(outlines.faces[f], receivers[r]->frame.n, region, weak_->strong(region),
                                          lights_[first + f], workspace);
            else if (search_)
                search_->look(outlines, receivers[r]->light, std::span(lights_).subspan(first, count), stop_, workspace,
                              receivers[r]->searched);
            else
                prepare_face_lights(stage_.direct, outlines, receivers[r]->light,
                                    std::span(lights_).subspan(first, count), stop_, workspace);
        });
    }

    void count_faces(const std::vector<std::optional<ReceiverCurves>>& receivers) {
        std::size_t candidates = 0, listed = 0, listed_faces = 0;
        for (const auto& receiver : receivers) {
            listed += receiver->searched.listed, listed_faces += receiver->searched.faces;
            report_.plane_tests += receiver->searched.plane_tests;
        }
        if (search_) report_.fragments = search_->fragments();
        const std::vector<ShadowClass> classes = shadow_classes();
        for (std::uint32_t f = 0; f < lights_.size(); ++f) {
            const ShadowClass c = classes[f];
            if (c == ShadowClass::penumbra) candidates += count_different(lights_[f].candidates);
            ++(c == ShadowClass::lit        ? report_.counts.lit
               : c == ShadowClass::penumbra ? report_.counts.penumbra
                                            : report_.counts.umbra);
        }
        if (report_.counts.penumbra > 0)
            report_.candidate_share = static_cast<double>(candidates) / static_cast<double>(report_.counts.penumbra) /
                                      static_cast<double>(stage_.pieces.size());
        // replaces the share computed above: these lists were counted before shadow volumes removed pieces that miss
        // the faces
        if (listed_faces > 0)
            report_.candidate_share = static_cast<double>(listed) / static_cast<double>(listed_faces) /
                                      static_cast<double>(stage_.pieces.size());
    }

    void record(RegionId r, const ReceiverCurves& receiver) {
        DiscontinuityCounts& counts = report_.counts;
        counts.wedges += receiver.wedges, counts.left_out += receiver.left_out;
        for (const FlatCurve& c : receiver.curves) {
            ++(c.order == CurveOrder::d0   ? counts.d0
               : c.order == CurveOrder::d1 ? counts.d1
               : c.order == CurveOrder::d2 ? counts.d2
                                           : counts.eee);
            report_.secondary_curves += std::any_of(options_.secondary.begin(), options_.secondary.end(),
                                                    [&](const SecondarySource& o) { return o.region == c.source; });
            curves_.push_back({r, receiver.frame.at(c.a), receiver.frame.at(c.b), c.order, c.cause, c.source});
            touched_[r.value] |= c.order == CurveOrder::d0 && c.cause == CurveCause::contact;
        }
        const bool is_dark = weak_ ? !weak_->is_reached(r) : receiver.light.is_dark();
        if (is_dark || region_.empty() || region_.back() != r) return;
        const Point inside = mesh_.centre(static_cast<std::uint32_t>(region_.size() - 1));
        touched_[r.value] |= stage_.occluders.is_covered(inside, receiver.frame.n, r);
    }

    /// Outline of a triangle for which blockers are searched. It is a little smaller than the triangle, whose sides
    /// follow shadows: blockers that only touch its lines of sight cast no shadow.
    std::vector<Point> inner_outline(std::uint32_t t) const {
        const auto& c = mesh_.triangles()[t].corner;
        return shrunk_triangle({mesh_.nodes()[c[0]].at, mesh_.nodes()[c[1]].at, mesh_.nodes()[c[2]].at},
                               mesh_limits::one_place * stage_.scene.size());
    }

    /// Classes of all triangles, by the view from their centres.
    std::vector<ShadowClass> shadow_classes() const {
        std::vector<ShadowClass> out(mesh_.triangles().size());
        parallel_ranges(out.size(), 64, [&](std::size_t first, std::size_t last) {
            DirectLight::Workspace workspace;
            for (std::size_t t = first; t < last; ++t)
                out[t] = class_at(mesh_.triangles()[t].face, mesh_.centre(static_cast<std::uint32_t>(t)), workspace);
        });
        return out;
    }

    ShadowClass class_at(std::uint32_t face, const Point& x, DirectLight::Workspace& workspace) const {
        const ReceiverLight& light = lights_[face];
        const RegionId r = region_[face];
        if (touched_[r.value] && stage_.occluders.is_covered(x, light.n, r)) return ShadowClass::umbra;
        if (!weak_) return shadow_class_at(stage_.direct, light, x, workspace);
        if (light.is_dark() && weak_->shines_on(r)) return ShadowClass::penumbra;
        return shadow_class_at(stage_.direct, light, x, weak_->strong(r), workspace);
    }

    /// Returns false if a request to stop ends it early.
    bool light_nodes(std::vector<std::uint32_t> nodes) {
        return values_.look_at(
            std::move(nodes),
            [&](std::uint32_t n, WeakLight::Workspace& workspace) { return light(mesh_.nodes()[n], workspace); }, stop_,
            [&] { keep(); });
    }

    Spectrum light(const BisectionMesh::Node& node, WeakLight::Workspace& workspace) const {
        const ReceiverLight& light = lights_[node.face];
        const RegionId r = region_[node.face];
        Spectrum out;
        const bool is_dark = light.is_dark() && !(weak_ && weak_->shines_on(r));
        if (!is_dark && !(touched_[r.value] && stage_.occluders.is_covered(node.seen_from, light.n, r))) {
            out = weak_ ? weak_->irradiance(light, node.seen_from, workspace)
                        : stage_.direct.irradiance(light, node.seen_from, workspace.exact);
            out = options_.direct_weight * out;
        }
        if (options_.indirect) out += options_.indirect(r, node.seen_from);
        return out;
    }

    /// Recomputes the misfits of triangles that have changed or are too bent to count as flat. With Clough-Tocher
    /// elements, all misfits are recomputed, since an element depends on its neighbours. Returns false if a request to
    /// stop ends it early.
    bool renew_misfits(const MisfitLimits& limits) {
        const auto weight_of = [&](std::uint32_t t) { return weight(region_[mesh_.triangles()[t].face]); };
        const std::vector<std::uint32_t> fresh = tried_.untried(mesh_, values_.values(), weight_of, limits);
        if (!light_nodes(TriedTriangles::places(mesh_, fresh))) return false;
        if (options_.clough_tocher) {
            const CloughTocherFit fit = clough_tocher();
            parallel_for(mesh_.triangles().size(), 256, [&](std::size_t i) {
                const auto t = static_cast<std::uint32_t>(i);
                tried_.set(t, fit.misfit(t, weight_of(t)));
            });
        } else {
            parallel_for(fresh.size(), 256, [&](std::size_t i) {
                tried_.set(fresh[i], misfit(mesh_, fresh[i], values_.values(), weight_of(fresh[i])));
            });
        }
        return true;
    }
    bool is_full() const { return mesh_.triangles().size() >= options_.max_triangles; }

    void refine(double tolerance) {
        // Aim below the largest error: nodes between which it is tested miss some of it.
        const MisfitLimits limits{
            tolerance * tolerance * area_, calibrated::part_aim * options_.largest_error * largest_,
            (weak_ ? mesh_limits::unfindable_area_among_many : mesh_limits::unfindable_area) * area_,
            mesh_limits::shortest_edge * stage_.scene.size(),
            options_.clough_tocher ? 0 : mesh_limits::tried_area * area_};
        constexpr int max_rounds = 60;
        for (int round = 0; round < max_rounds; ++round) {
            if (!light_nodes(tried_.forget_changed(mesh_))) {
                if (lit_) mesh_ = std::move(*lit_);
                return;
            }
            is_lit_ = true;
            if (!renew_misfits(limits)) return;
            const std::vector<std::uint32_t> coarse = coarse_triangles(mesh_, tried_.misfits(), limits);
            if (coarse.empty() || is_full() || stop_.requested()) return;
            // State to return to after a stop. Copying it per tenth of growth takes little time.
            if (!lit_ || mesh_.triangles().size() - lit_->triangles().size() > lit_->triangles().size() / 10)
                lit_ = mesh_;
            // Skip triangles that were bisected together with a neighbour: their misfits are out of date.
            const std::size_t before = mesh_.triangles().size();
            std::vector<std::uint8_t> depth(before);
            for (std::size_t t = 0; t < before; ++t) depth[t] = mesh_.triangles()[t].depth;
            for (const std::uint32_t t : coarse)
                if (mesh_.triangles()[t].depth == depth[t]) mesh_.bisect(t);
            renew_faces();
        }
    }

    /// Gives triangles far smaller than their face, with many candidates, a face of their own, with fewer blockers.
    void renew_faces() {
        if (search_) return;
        constexpr std::uint8_t min_depth = 5;
        constexpr std::size_t min_candidates = 12;
        std::vector<std::uint32_t> renewed, before;
        for (std::uint32_t t = 0; t < mesh_.triangles().size(); ++t) {
            const BisectionMesh::Triangle& now = mesh_.triangles()[t];
            if (now.depth < min_depth || lights_[now.face].candidates.size() < min_candidates) continue;
            renewed.push_back(t), before.push_back(now.face);
        }
        const std::size_t base = lights_.size();
        lights_.resize(base + renewed.size());
        parallel_ranges(renewed.size(), 16, [&](std::size_t first, std::size_t last) {
            DirectLight::Workspace workspace;
            for (std::size_t i = first; i < last; ++i)
                stage_.direct.prepare(inner_outline(renewed[i]), lights_[before[i]], lights_[base + i], workspace);
        });
        for (std::size_t i = 0; i < renewed.size(); ++i) {
            region_.push_back(region_[before[i]]);
            mesh_.set_face(renewed[i], static_cast<std::uint32_t>(base + i));
        }
    }

    SixNodeMesh finish() {
        SixNodeMesh out = finished_mesh(mesh_, values_.values(), region_);
        out.curves = curves_;
        if (options_.clough_tocher) clough_tocher().write(out);
        report_.counts.triangles = out.size();
        report_.counts.mean_radius_ratio = out.mean_radius_ratio();
        return out;
    }

    double error_at_places(const SixNodeMesh& mesh) const {
        const SixNodeLocator locator(mesh, stage_.scene);
        return places_->error([&](RegionId r, const Point& p) { return locator.at(r, p); });
    }

    CloughTocherFit clough_tocher() const {
        return CloughTocherFit(mesh_, values_.values(), [&](std::uint32_t t) {
            return stage_.scene.regions()[region_[mesh_.triangles()[t].face]].plane.n;
        });
    }

    const Stage& stage_;
    const DiscontinuityOptions& options_;
    DiscontinuityReport& report_;
    const StopRequest& stop_;
    BisectionMesh mesh_;
    std::optional<BisectionMesh> lit_;   ///< Copy of the mesh at a time when all of its nodes had light.
    std::vector<std::uint8_t> touched_;  ///< Per region: true if anything covers parts of it.
    std::vector<RegionId> region_;       ///< Per face.
    std::vector<ReceiverLight> lights_;  ///< Per face.
    NodeValues values_;
    bool is_lit_ = false;  ///< True once every triangle has light.
    MeshProgress found_;   ///< Results of an earlier run, and the curves of this one.
    TriedTriangles tried_;
    std::unique_ptr<BlockerSearch> search_;   ///< The search for blockers; null: shafts and a tree of boxes are used.
    Field<RegionId, std::uint8_t> followed_;  ///< With curves on named surfaces only: 1 for these. Else empty.
    std::optional<WeakLight> weak_;           ///< Set if weak sources are estimated by rays.
    std::optional<ExactPlaces> places_;
    std::vector<DiscontinuityCurve> curves_;
    double largest_ = 0, area_ = 0;
};

}  // namespace

SixNodeMesh make_discontinuity_mesh(const Stage& stage, const DiscontinuityOptions& options,
                                    DiscontinuityReport& report, const StopRequest& stop) {
    return Builder(stage, options, report, stop).run();
}

}  // namespace exitance
