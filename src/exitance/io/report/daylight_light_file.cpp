#include "exitance/io/report/daylight_light_file.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "exitance/base/version.hpp"
#include "exitance/io/files/sha256.hpp"
#include "exitance/io/solution/checkpoint_file.hpp"
#include "exitance/io/solution/hdf5_file.hpp"

namespace exitance {
namespace {

const std::string group = "daylight";

std::string name_of(std::size_t replicate) {
    return fmt::format("{}/reflected_{}", group, replicate);
}

/// Adds numbers to a hash.
class NumberHash {
  public:
    void add(std::string_view text) { hash_.add_text(text); }
    template <class... Numbers>
    void add(Numbers... numbers) requires(std::is_arithmetic_v<Numbers>&&...) {
        const std::array<double, sizeof...(Numbers)> all{static_cast<double>(numbers)...};
        hash_.add(std::string_view(reinterpret_cast<const char*>(all.data()), sizeof all));
    }
    std::string finish() { return hash_.finish(); }

  private:
    Sha256 hash_;
};

}  // namespace

std::string fingerprint_of(const Scene& scene, const DaylightTask& task) {
    NumberHash hash;
    hash.add(program_version), hash.add(scene_fingerprint(scene));
    for (const auto& [x, n] : task.sensors) hash.add(x.x, x.y, x.z, n.x, n.y, n.z);
    for (const SensorGrid& grid : task.grids) hash.add(grid.name), hash.add(grid.count);
    for (const DaylightHour& h : task.hours)
        hash.add(h.time.year, h.time.month, h.time.day, h.time.hour, h.time.zone, h.hour, h.diffuse_horizontal,
                 h.direct_normal);
    const DaylightSite& s = task.site;
    hash.add(s.place.latitude, s.place.longitude, s.place.elevation, s.place.pressure, s.place.temperature, s.zone,
             s.north, s.ground, s.efficacy_diffuse, s.efficacy_direct);
    const DaylightCriteria& c = task.criteria;
    hash.add(c.target, c.useful[0], c.useful[1], c.useful[2], c.dimmed_power);
    for (std::size_t h = 0; h < task.hours.size(); ++h) hash.add(c.is_occupied(task.hours[h], h));
    hash.add(task.division, task.error);
    if (task.sun_day) hash.add(task.sun_day->month, task.sun_day->day, task.sun_day->min_altitude);
    return hash.finish();
}

Result<void> write_daylight_light(const std::string& path, const std::string& fingerprint, const DaylightLight& light) {
    Hdf5Writer file(path);
    file.make_group(group);
    file.set_attribute(group, "fingerprint", std::string_view(fingerprint));
    const DaylightOptions& options = light.options;
    file.set_attribute(group, "elements", options.elements);
    file.set_attribute(group, "rays_an_element", options.rays_an_element);
    file.set_attribute(group, "rays_a_sensor", static_cast<std::int64_t>(options.rays_a_sensor));
    file.set_attribute(group, "seed", static_cast<std::int64_t>(options.seed));
    file.set_attribute(group, "bias_elements", light.bias.elements);
    file.set_attribute(group, "bias_patches", light.bias.patches);
    file.set_attribute(group, "bias_sensors", static_cast<std::int64_t>(light.bias.sensors));
    file.set_attribute(group, "patches", static_cast<std::int64_t>(light.elements.columns));
    for (std::size_t k = 0; k < daylight_replicates; ++k)
        file.write(name_of(k), light.elements.reflected[k], light.elements.columns,
                   {"lx m^2/cd", "reflected light of each element, by patch of the sky"});
    return file.commit();
}

Result<std::optional<DaylightLight>> read_daylight_light(const std::string& path, const std::string& fingerprint) {
    std::error_code failure;
    if (!std::filesystem::exists(path, failure)) return std::optional<DaylightLight>();
    Result<Hdf5Reader> file = Hdf5Reader::open(path);
    if (!file) return file.error();
    if (file->text_attribute(group, "fingerprint") != fingerprint) return std::optional<DaylightLight>();
    DaylightLight out;
    const auto number = [&](const char* name) { return file->number_attribute(group, name).value_or(0); };
    const auto integer = [&](const char* name) { return file->integer_attribute(group, name).value_or(0); };
    out.options = {number("elements"), number("rays_an_element"), static_cast<unsigned>(integer("rays_a_sensor")),
                   static_cast<std::uint64_t>(integer("seed"))};
    out.bias = {number("bias_elements"), number("bias_patches"), static_cast<std::size_t>(integer("bias_sensors"))};
    out.elements.columns = static_cast<std::size_t>(integer("patches"));
    for (std::size_t k = 0; k < daylight_replicates; ++k)
        out.elements.reflected[k] = file->read<float>(name_of(k), std::max<std::size_t>(1, out.elements.columns));
    if (file->failed()) return file->error();
    return std::optional<DaylightLight>(std::move(out));
}

}  // namespace exitance
