#include "exitance/lab/tasks/patch_pool.hpp"

#include <cmath>
#include <thread>

#include "exitance/base/random.hpp"

namespace exitance {
namespace {

/// Multiplication by the third element of the field of four elements, whose addition is exclusive or.
constexpr unsigned twice[4] = {0, 2, 3, 1};

/// Orthogonal array OA(16, 4, 4, 2): ray (a, b) leads from cell (a, b) to cell (a + b, a + 2 b), in that field's
/// arithmetic.
constexpr std::array<unsigned, RayEnds::size> partner = [] {
    std::array<unsigned, RayEnds::size> cell{};
    for (unsigned a = 0; a < 4; ++a)
        for (unsigned b = 0; b < 4; ++b) cell[4 * a + b] = 4 * (a ^ b) + (a ^ twice[b]);
    return cell;
}();

/// Points of equal weight: the 2 x 2 Gauss points of a parallelogram, or three points of a triangle (degree 2).
std::array<Point, 4> receiving_points(const Patch& shape) {
    std::array<Point, 4> out;
    if (shape.is_triangle()) {
        const std::array<Vec2, 3> uv{{{1.0 / 6, 1.0 / 6}, {2.0 / 3, 1.0 / 6}, {1.0 / 6, 2.0 / 3}}};
        for (std::size_t i = 0; i < uv.size(); ++i) out[i] = shape.at(uv[i]);
        return out;
    }
    const double h = 0.5 / std::sqrt(3.0);
    for (std::size_t i = 0; i < 4; ++i) out[i] = shape.at(0.5 + (i & 1 ? h : -h), 0.5 + (i & 2 ? h : -h));
    return out;
}

}  // namespace

PatchPool::PatchPool(const Stage& stage, std::uint64_t seed)
    : stage_(stage), seed_(seed), chunks_(std::make_unique<std::atomic<TaskPatch*>[]>(max_chunks)) {
    root_count_ = static_cast<std::uint32_t>(stage.pieces.size());
    for (std::uint32_t i = 0; i < root_count_; ++i) {
        TaskPatch& patch = (*this)[allocate(1)];
        patch.polygon = i;
        set_up(patch, stage.pieces[i].region, stage.pieces[i].patch);
        patch.radiosity.fill(stage.scene.material(patch.region).exitance);
    }
}

PatchPool::~PatchPool() {
    for (std::size_t i = 0; i < max_chunks; ++i) delete[] chunks_[i].load();
}

std::uint32_t PatchPool::allocate(std::uint32_t count) {
    const std::uint32_t first = size_.fetch_add(count, std::memory_order_acq_rel);
    EXI_CHECK((first + count) / chunk < max_chunks);
    for (std::uint32_t c = first / chunk; c <= (first + count - 1) / chunk; ++c) {
        if (chunks_[c].load(std::memory_order_acquire)) continue;
        auto fresh = std::make_unique<TaskPatch[]>(chunk);
        TaskPatch* expected = nullptr;
        if (chunks_[c].compare_exchange_strong(expected, fresh.get(), std::memory_order_acq_rel)) fresh.release();
    }
    return first;
}

void PatchPool::set_up(TaskPatch& patch, RegionId region, const Patch& shape) {
    patch.shape = shape;
    patch.region = region;
    patch.plane = stage_.scene.regions()[region].plane;
    patch.area = shape.area();
    patch.corner_count = static_cast<std::uint8_t>(shape.corner_count());
    for (int i = 0; i < shape.corner_count(); ++i) patch.corners[static_cast<std::size_t>(i)] = shape.corner(i);
    patch.receiving = receiving_points(shape);
    patch.places = stage_.tracer.ray_ends(places(patch), region);
}

std::array<Point, RayEnds::size> PatchPool::places(const TaskPatch& patch) const {
    RandomStream random(seed_, Stream::visibility, hash(patch.polygon, patch.level), patch.path);
    std::array<Point, RayEnds::size> out;
    for (unsigned k = 0; k < RayEnds::size; ++k) {
        const double s = (k / 4 + random.uniform()) / 4, t = (k % 4 + random.uniform()) / 4;
        out[k] = patch.shape.at(uniform_in_shape(patch.shape.shape, s, t));
    }
    return out;
}

std::uint32_t PatchPool::children(std::uint32_t parent, std::size_t slot) {
    TaskPatch& patch = (*this)[parent];
    std::uint32_t first = patch.first_child.load(std::memory_order_acquire);
    if (first == TaskPatch::none &&
        patch.first_child.compare_exchange_strong(first, TaskPatch::being_made, std::memory_order_acq_rel)) {
        const std::vector<Patch> shapes = cut(patch.shape, Cut::both);
        first = allocate(static_cast<std::uint32_t>(shapes.size()));
        for (std::uint32_t c = 0; c < shapes.size(); ++c) {
            TaskPatch& child = (*this)[first + c];
            child.polygon = patch.polygon;
            child.parent = parent;
            child.level = static_cast<std::uint8_t>(patch.level + 1);
            child.path = patch.path | std::uint64_t(c) << (2 * (31 - patch.level));
            set_up(child, patch.region, shapes[c]);
            child.radiosity[slot] = patch.radiosity[slot];
        }
        patch.first_child.store(first, std::memory_order_release);
    }
    while (first == TaskPatch::being_made) {  // while another thread makes the four patches
        std::this_thread::yield();
        first = patch.first_child.load(std::memory_order_acquire);
    }
    return first;
}

unsigned PatchPool::turn(const TaskPatch& p, const TaskPatch& q, std::size_t group) const {
    const std::uint64_t of_p = hash(p.polygon, p.level, p.path), of_q = hash(q.polygon, q.level, q.path);
    return static_cast<unsigned>(hash(seed_, of_p, of_q) >> (4 * group % 64)) & 15u;
}

std::pair<RayEnds, RayEnds> PatchPool::rays(const TaskPatch& p, const TaskPatch& q, std::size_t group) const {
    const unsigned digits = turn(p, q, group);
    RayEnds to;
    for (unsigned k = 0; k < RayEnds::size; ++k) {
        const unsigned from = partner[k] ^ digits;
        to.x[k] = q.places.x[from], to.y[k] = q.places.y[from], to.z[k] = q.places.z[from];
    }
    return {p.places, to};
}

std::uint32_t PatchPool::facing_rays(const TaskPatch& p, const TaskPatch& q, std::size_t group) const {
    const auto in_front = [](const TaskPatch& a, const TaskPatch& b) {
        return std::all_of(a.corners.begin(), a.corners.begin() + a.corner_count,
                           [&](const Point& x) { return b.plane.signed_distance(x) >= 0; });
    };
    constexpr std::uint32_t all = 0xffffu;
    if (in_front(p, q) && in_front(q, p)) return all;
    const unsigned digits = turn(p, q, group);
    const std::array<Point, RayEnds::size> from = places(p), to = places(q);
    std::uint32_t facing = 0;
    for (unsigned k = 0; k < RayEnds::size; ++k)
        if (q.plane.signed_distance(from[k]) > 0 && p.plane.signed_distance(to[partner[k] ^ digits]) > 0)
            facing |= 1u << k;
    return facing;
}

std::size_t PatchPool::memory_bytes() const {
    return size() * sizeof(TaskPatch);
}

}  // namespace exitance
