// Share of rays in the time of a progressive solve with `--visibility fractional`, and their speed compared with
// Embree's own packets:
//
//     exitance-shooting-queries SCENE.obj [MESH_SIZE=1]
//
// One thread, CPU seconds. First runs the whole solve, from scene to solution. Then computes the visible shares of the
// pairs of elements that its columns need, timed in blocks, and after each block runs rtcOccluded16 on the same
// packets, made in advance. A query includes everything from two elements to their visible share. The results of both
// are compared.
#if EXITANCE_EMBREE_MAJOR == 3
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "exitance/base/triangulation.hpp"
#include "exitance/io/scenes/scene_file.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/transport/patch_transfer.hpp"

namespace {

using namespace exitance;

double cpu_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

#if EXITANCE_EMBREE_MAJOR == 3

using QueryArguments = RTCIntersectContext;

QueryArguments make_arguments() {
    QueryArguments arguments;
    rtcInitIntersectContext(&arguments);
    arguments.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return arguments;
}

void trace_occluded(const int* valid, RTCScene scene, QueryArguments& arguments, RTCRay16& packet) {
    rtcOccluded16(valid, scene, &arguments, &packet);
}

#else

using QueryArguments = RTCOccludedArguments;

QueryArguments make_arguments() {
    QueryArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    return arguments;
}

void trace_occluded(const int* valid, RTCScene scene, QueryArguments& arguments, RTCRay16& packet) {
    rtcOccluded16(valid, scene, &packet, &arguments);
}

#endif

/// The triangles of a scene in a separate Embree scene, in the coordinates of RayEnds.
class RawScene {
  public:
    explicit RawScene(const Scene& scene) {
        const double scale = std::exp2(-std::ilogb(scene.size()));
        std::vector<std::array<float, 3>> corners;
        std::vector<std::array<std::uint32_t, 3>> triangles;
        for (SurfaceId s : scene.surfaces().ids()) {
            const auto first = static_cast<std::uint32_t>(corners.size());
            for (const Point& p : scene.outline(s)) {
                const Vec3 q = scale * (p - scene.box().centre());
                corners.push_back({static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)});
            }
            for (const auto& t : triangulate(scene.outline(s), scene.surfaces()[s].normal))
                triangles.push_back({first + t[0], first + t[1], first + t[2]});
        }
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* points = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                               sizeof(corners[0]), corners.size());
        void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                sizeof(triangles[0]), triangles.size());
        std::copy(corners.begin(), corners.end(), static_cast<std::array<float, 3>*>(points));
        std::copy(triangles.begin(), triangles.end(), static_cast<std::array<std::uint32_t, 3>*>(indices));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        rtcCommitScene(scene_);
    }
    ~RawScene() {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    RawScene(const RawScene&) = delete;
    RawScene& operator=(const RawScene&) = delete;

    static RTCRay16 packet(const RayEnds& from, const RayEnds& to) {
        alignas(64) RTCRay16 packet{};
        for (std::size_t k = 0; k < RayEnds::size; ++k) {
            packet.org_x[k] = from.x[k], packet.org_y[k] = from.y[k], packet.org_z[k] = from.z[k];
            packet.dir_x[k] = to.x[k] - from.x[k], packet.dir_y[k] = to.y[k] - from.y[k];
            packet.dir_z[k] = to.z[k] - from.z[k], packet.tfar[k] = 1, packet.mask[k] = 0xffffffffu;
        }
        return packet;
    }

    void trace(std::span<RTCRay16> packets) {
        for (RTCRay16& packet : packets) trace_occluded(all_, scene_, arguments_, packet);
    }

  private:
    RTCDevice device_ = rtcNewDevice(nullptr);
    RTCScene scene_ = rtcNewScene(device_);
    QueryArguments arguments_ = make_arguments();
    alignas(64) int all_[16] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};
};

struct Times {
    double queries = 0, raw = 0;  ///< CPU seconds.
    std::size_t rays = 0, different = 0;
};

/// Measures pairs with a form factor above 0 for every `step`-th source, in the order of its column.
Times measure(const PatchTransfer& transfer, std::span<const ElementId> elements, RawScene& raw, std::size_t step) {
    constexpr std::size_t block = 256;
    Times times;
    std::vector<RTCRay16> packets;
    std::vector<double> shares(block);
    PatchTransfer::Workspace workspace;
    for (std::size_t j = 0; j < elements.size(); j += step) {
        std::vector<ElementId> receivers;
        for (ElementId e : elements)
            if (transfer.form_factor_in_the_open(e, elements[j]) > 0) receivers.push_back(e);
        for (std::size_t first = 0; first < receivers.size(); first += block) {
            const std::size_t count = std::min(block, receivers.size() - first);
            const double before = cpu_seconds();
            for (std::size_t k = 0; k < count; ++k)
                shares[k] = transfer.visible_share(receivers[first + k], elements[j], workspace);
            times.queries += cpu_seconds() - before;
            packets.clear();
            for (std::size_t k = 0; k < count; ++k) {
                const auto [from, to] = transfer.rays(receivers[first + k], elements[j], 0);
                packets.push_back(RawScene::packet(from, to));
            }
            const double between = cpu_seconds();
            raw.trace(packets);
            times.raw += cpu_seconds() - between;
            times.rays += RayEnds::size * count;
            for (std::size_t k = 0; k < count; ++k) {
                int open = 0;
                for (float far : packets[k].tfar) open += far >= 0;
                times.different += shares[k] != open / 16.0;
            }
        }
    }
    return times;
}

int run(const char* name, double edge) {
    const CheckedScene checked = load_scene(name);
    if (!checked.scene) return std::fprintf(stderr, "%s: no scene\n", name), 2;
    const Scene& scene = *checked.scene;
    set_threads(1);
    Progress progress;
    const double start = cpu_seconds();
    const Result<Solution> solution = solve_scene(scene,
                                                  {.method = Method::progressive,
                                                   .mesh_size = edge,
                                                   .visibility = VisibilityKind::fractional,
                                                   .visibility_samples = RayEnds::size,
                                                   .threads = 1},
                                                  progress, StopRequest());
    const double whole = cpu_seconds() - start;
    if (!solution) return std::fprintf(stderr, "%s\n", solution.error().message.c_str()), 2;

    const Stage stage(scene);
    const ElementTree tree = stage.make_elements({edge, 0});
    const PatchTransfer transfer(stage, tree, RayEnds::size, 1);
    RawScene raw(scene);
    const std::vector<ElementId> elements = tree.leaves();
    const Times times = measure(transfer, elements, raw, elements.size() / 64 + 1);
    const auto all_rays = static_cast<double>(solution->statistics.rays), rays = static_cast<double>(times.rays);
    std::printf("solve     %.2f s, %.3g rays\n", whole, all_rays);
    std::printf("queries   %.1f ns a ray, %.0f%% of the solve\n", 1e9 * times.queries / rays,
                100 * all_rays * times.queries / rays / whole);
    std::printf("embree    %.1f ns a ray, %.0f%% of the solve; queries reach %.2f of its throughput\n",
                1e9 * times.raw / rays, 100 * all_rays * times.raw / rays / whole, times.raw / times.queries);
    std::printf("answers   %zu of %zu packets differ\n", times.different, times.rays / RayEnds::size);
    return 0;
}

}  // namespace

int main(int count, char** words) {
    if (count < 2) return std::fprintf(stderr, "usage: %s SCENE.obj [MESH_SIZE]\n", words[0]), 2;
    return run(words[1], count > 2 ? std::atof(words[2]) : 1);
}
