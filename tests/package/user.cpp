#include <exitance/daylight.hpp>
#include <exitance/glare.hpp>
#include <exitance/light_maps.hpp>
#include <exitance/light_probes.hpp>
#include <exitance/load.hpp>
#include <exitance/picture.hpp>
#include <exitance/solve.hpp>
#include <exitance/view_factors.hpp>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <thread>

#include "small_room.hpp"

// Calls the public functions of an installed library, and prints the claims that do not hold.

using namespace exitance::api;

namespace {

int failures = 0;

void expect(bool holds, const char* claim) {
    if (holds) return;
    std::fprintf(stderr, "does not hold: %s\n", claim);
    ++failures;
}

/// Counts the reports of a run, and requests a stop after `most` of them.
class Counter : public Progress {
  public:
    explicit Counter(StopRequest* stop = nullptr, int most = 0) : stop_(stop), max_(most) {}
    void phase(std::string_view) override {
        ++phases;
        if (stop_ && phases >= max_) stop_->request();
    }
    int phases = 0;

  private:
    StopRequest* stop_;
    int max_;
};

void check_scene(const Scene& scene) {
    expect(scene.size() == 7 && scene.materials().size() == 2, "the scene has 7 faces and 2 materials");
    expect(std::abs(scene.area() - (2 * 12 + 2 * 10 + 2 * 7.5 + 1)) < 1e-12, "areas of faces add up");
    const Face lamp = scene.face(6);
    expect(lamp.normal == Vec3{0, 0, -1} && lamp.outline.size() == 4 && scene.groups()[lamp.group] == "lamp",
           "the lamp faces down");
    expect(scene.highest() == Vec3{4, 3, 2.5} && scene.has_light() && !scene.is_photometric(), "bounds and light");
}

void check_errors(const Scene& scene, const std::string& folder) {
    const Result<Scene> missing = load(folder + "/missing.obj");
    expect(!missing && missing.error().code == ErrorCode::cannot_read && !missing.error().where.empty(),
           "a missing file is an error that names it");
    const Result<Solution> wrong = solve(scene, {.method = "magic"});
    expect(!wrong && wrong.error().code == ErrorCode::usage && !wrong.error().hint.empty(), "methods are checked");
    expect(!solve(scene, {.error = -1}), "errors are checked");
    expect(!solve(scene, {.more = {{"recipe", "hanrahan91"}}}), "published forms are refused");
    expect(!solve(scene, {.more = {{"mesh-sise", "1"}}}), "unknown options are refused");
    bool thrown = false;
    try {
        solve(scene, {.method = "magic"}).value();
    } catch (const Failure& failure) {
        thrown = std::strstr(failure.what(), failure.error().message.c_str()) != nullptr;
    }
    expect(thrown, "value() throws the error");
    SceneDescription bad;
    bad.corner_counts = {3}, bad.corners = {0, 1, 2}, bad.material = {0};
    expect(!make_scene(bad), "indices are checked");
    const Probe flat[] = {{{1, 1, 1}, {0, 0, 0}}};
    expect(!solve(scene, {.error = 0.1}).value().light(flat), "normals are checked");
}

void check_solution(const Scene& scene, const std::string& folder) {
    Counter counter;
    const Solution solution = solve(scene, {.error = 0.05}, {.progress = &counter}).value();
    expect(counter.phases > 2, "a solve reports its phases");
    expect(solution.converged() && *solution.error() <= 0.05 && *solution.error_bound() >= *solution.error(),
           "the requested error is reached");
    // The lamp emits 30 W/m^2 from 1 m^2.
    expect(std::abs(solution.energy().emitted - 30) < 1e-9 && solution.energy().defect < 0.05, "energy is conserved");
    expect(solution.statistics_json().find("\"relative_error_estimate\"") != std::string::npos, "statistics are JSON");

    const Probe probes[] = {{{2, 1.5, 0}, {0, 0, 1}}, {{1, 1, 1}, {0, 0, 3}}};
    const std::vector<Light> all = solution.light(probes).value();
    const std::vector<Light> direct = solution.light(probes, Component::direct).value();
    const std::vector<Light> indirect = solution.light(probes, Component::indirect).value();
    expect(all[0].on_surface && !all[1].on_surface, "probes on surfaces are found");
    for (int i : {0, 1})
        expect(std::abs(mean(all[i].irradiance) - mean(direct[i].irradiance) - mean(indirect[i].irradiance)) <
                   1e-9 * mean(all[i].irradiance),
               "direct and indirect light add up");
    // A square of 1 m parallel to the floor, 2 m above the point below its centre: F = 4/pi (x/w) atan(x/w), x = 0.5,
    // w = sqrt(x^2 + 2^2), by the formula for a corner, four times.
    const double w = std::hypot(0.5, 2.0), F = 4 / std::acos(-1.0) * (0.5 / w) * std::atan(0.5 / w);
    expect(std::abs(mean(direct[0].irradiance) - 30 * F) < 1e-9 * 30 * F, "direct light is exact");

    solution.save(folder + "/room.h5").value();
    const Solution again = load_solution(folder + "/room.h5").value();
    expect(again.light(probes).value()[1].irradiance == all[1].irradiance, "a stored solution gives the same bits");
    const Mesh mesh = again.mesh().value();
    expect(!mesh.triangles.empty() && mesh.face.size() == mesh.triangles.size() &&
               mesh.irradiance.size() == mesh.vertices.size(),
           "the mesh has light at its vertices");
    double area = 0;
    for (const auto& t : mesh.triangles) {
        const auto at = [&](std::uint32_t v) {
            return Vec3{mesh.vertices[v][0], mesh.vertices[v][1], mesh.vertices[v][2]};
        };
        area += 0.5 * norm(cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])));
    }
    expect(std::abs(area - scene.area()) < 1e-5 * area, "triangles cover all faces");  // single precision
    again.export_mesh(folder + "/room.glb").value();

    const Picture picture = render(again, {.width = 60, .height = 40, .samples = 4}).value();
    expect(picture.radiance().size() == 2400 && picture.display().size() == 2400, "pictures have their size");
    picture.save(folder + "/room.png").value();
    expect(!picture.save(folder + "/room.tiff"), "kinds of pictures are checked");
    const LightMaps maps = bake(again, {.density = 8}).value();
    expect(maps.size() >= 1 && maps.charts().size() == 7 && maps.density() == 8, "every face has a chart");
    maps.save(folder + "/maps").value();

    const Glare seen = glare(again, {0.2, 1.5, 1.2}, {1, 0, 0.2}).value();
    expect(seen.probability > 0 && seen.vertical_illuminance > 0 && seen.bounds.has_value(), "glare has bounds");
    expect(!glare(again, {0.2, 1.5, 1.2}, {0, 0, 0}), "a line of sight has a length");
    const Vec3 middle{2, 1.5, 1.5};
    const std::vector<LightProbe> air = light_probes(again, {&middle, 1}).value();
    expect(air.size() == 1 && mean(air[0].irradiance({0, 0, 1})) > mean(air[0].irradiance({0, 0, -1})),
           "more light comes from above");
    expect(!light_probes(again, {&middle, 1}, {.rays = 100}), "rays are a power of two");
}

void check_stop(const Scene& scene) {
    StopRequest stop;
    Counter counter(&stop, 1);
    const Result<Solution> stopped = solve(scene, {.error = 1e-4}, {.progress = &counter, .stop = &stop});
    expect(stopped ? stopped->stopped_by() == "interrupt" : stopped.error().code == ErrorCode::limit,
           "a stop ends a solve");
    const Result<Solution> late = solve(scene, {.error = 1e-6, .time_limit = 0.5});
    expect(late ? late->stopped_by() == "time limit" && !late->converged() : late.error().code == ErrorCode::limit,
           "a time limit ends a solve");
}

void check_groups() {
    const Scene scene = small_room(true).value();
    const Solution solution = solve(scene, {.error = 0.1}).value();
    expect(solution.light_groups() == std::vector<std::string>{"lamp"}, "the lamp is a light group");
    const Probe probe[] = {{{2, 1.5, 0}, {0, 0, 1}}};
    const double before = mean(solution.light(probe).value()[0].irradiance);
    const double after = mean(solution.mix({.dim = {{"lamp", 0.5}}}).value().light(probe).value()[0].irradiance);
    expect(std::abs(after - 0.5 * before) < 1e-5 * before, "half the lamp is half the light");  // single precision
    expect(!solution.mix({.dim = {{"sun", 0.5}}}), "unknown groups are refused");
}

void check_view_factors(const Scene& scene, const std::string& folder) {
    const ViewFactors F = view_factors(scene, {.error = 1e-2}).value();
    expect(F.areas.size() == 7 && F.starts.size() == 8, "there is one row per face");
    for (std::size_t i = 0; i < 6; ++i)
        expect(F.row_sums[i] > 0.9 && F.row_sums[i] < 1.02, "rows of walls sum to 1 less the back of the lamp");
    save(F, folder + "/room.mtx").value();
    expect(!view_factors(scene, {.error = 0}), "errors of view factors are checked");
}

/// Two solves on two threads take turns and give the same bits.
void check_threads(const Scene& scene) {
    const Probe probe[] = {{{1, 1, 0}, {0, 0, 1}}};
    Spectrum light[2];
    std::thread other([&] { light[0] = solve(scene, {.error = 0.1}).value().light(probe).value()[0].irradiance; });
    light[1] = solve(scene, {.error = 0.1, .threads = 1}).value().light(probe).value()[0].irradiance;
    other.join();
    expect(light[0] == light[1], "solves on two threads give the same bits");
}

}  // namespace

int main(int, char** arguments) {
    const std::string folder = arguments[1];
    const Scene scene = small_room().value();
    check_scene(scene);
    check_errors(scene, folder);
    check_solution(scene, folder);
    check_stop(scene);
    check_groups();
    check_view_factors(scene, folder);
    check_threads(scene);
    return failures == 0 ? 0 : 1;
}
