#include "exitance/io/solution/checkpoint_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <limits>

#include "exitance/base/random.hpp"
#include "exitance/base/version.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/processes/distributed.hpp"
#include "exitance/scene/sky/sky_picture.hpp"

namespace exitance {
namespace {

constexpr std::string_view first_line = "exitance checkpoint 2\n";

/// Hash of a sequence of numbers.
class Fingerprint {
  public:
    void add(double v) { hash_ = hash(hash_, std::bit_cast<std::uint64_t>(v)); }
    void add(const Vec3& v) { add(v.x), add(v.y), add(v.z); }
    void add(const Spectrum& s) {
        for (double v : s.value) add(v);
    }
    std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0;
};

Error damaged(const std::string& path) {
    return {ErrorCode::bad_input, "is damaged, or no checkpoint of this version", path,
            "without --resume the solve begins anew"};
}

/// Describes the first fact that differs; empty if all are equal.
std::string difference(const CheckpointFacts& kept, const CheckpointFacts& own) {
    for (const auto& [name, value] : own) {
        const auto at = std::find_if(kept.begin(), kept.end(), [&, &n = name](const auto& f) { return f.first == n; });
        const std::string other = at == kept.end() ? "unknown" : at->second;
        if (other != value) return name + " was " + other + " and is " + value;
    }
    return kept.size() == own.size() ? "" : "it was made by another version";
}

/// Checksum of the running program's file, since the layout of states depends on the program.
const std::string& program_fingerprint() {
    static const std::string text = [] {
        const Result<std::string> program = read_whole_file("/proc/self/exe");
        return program ? fmt::format("{:016x}", checksum(*program)) : "unknown";
    }();
    return text;
}

}  // namespace

std::string scene_fingerprint(const Scene& scene) {
    Fingerprint all;
    for (SurfaceId s : scene.surfaces().ids()) {
        const Surface& surface = scene.surfaces()[s];
        for (const Point& p : scene.outline(s)) all.add(p);
        all.add(surface.material.value), all.add(surface.region.value);
    }
    for (const Material& material : scene.materials()) {
        all.add(material.reflectance), all.add(material.exitance), all.add(material.through);
        if (!material.is_directed()) continue;
        const DirectedEmission& emission = material.emission;
        all.add(static_cast<double>(emission.profile.value)), all.add(emission.scale);
        all.add(emission.x), all.add(emission.y), all.add(emission.z);
    }
    for (const EmissionProfile& profile : scene.profiles()) {
        all.add(static_cast<double>(profile.body)), all.add(profile.size);
        for (const double v : profile.values) all.add(v);
        for (const EmissionProfile::Axis& axis : profile.axes) {
            all.add(static_cast<double>(axis.angle)), all.add(axis.offset);
            for (const double v : axis.at) all.add(v);
        }
    }
    for (const PunctualLight& light : scene.lights()) {
        all.add(static_cast<double>(light.kind));
        all.add(light.position), all.add(light.direction), all.add(light.intensity);
        all.add(light.inner_cone), all.add(light.outer_cone);
    }
    for (const Pane& pane : scene.panes()) {
        for (const Point& p : pane.corners) all.add(p);
        all.add(pane.transmissivity), all.add(pane.index);
    }
    for (const DistantLight::Dome& dome : scene.distant().domes) {
        const SkyModel& m = dome.model;
        for (const double v : {m.a, m.b, m.g, m.f0, m.c, m.d, m.e, m.ground, m.scale}) all.add(v);
        all.add(m.sun), all.add(dome.irradiance);
        all.add(m.intermediate + 2.0 * m.blends_ground + 4.0 * m.below);
        if (m.picture)
            for (const double v : m.picture->values()) all.add(v);
    }
    for (const DistantLight::Disc& disc : scene.distant().discs)
        all.add(disc.towards), all.add(disc.half_angle), all.add(disc.irradiance);
    return fmt::format("{:016x}", all.value());
}

CheckpointFile::CheckpointFile(std::string path, CheckpointFacts facts, double every)
    : path_(std::move(path)), facts_(std::move(facts)), every_(every) {
    facts_.emplace_back("the version", program_version);
    facts_.emplace_back("the build", program_fingerprint());
}

Result<bool> CheckpointFile::load() {
    bool is_there = false;
    const Result<void> done = by_first([&]() -> Result<void> {
        const Result<bool> found = read();
        if (!found) return found.error();
        is_there = *found;
        return {};
    });
    if (!done) return done.error();
    state_ = as_first(std::move(state_), "checkpoint");
    return as_first(is_there);
}

/// Reads the checkpoint in the first process.
Result<bool> CheckpointFile::read() {
    std::error_code ignored;
    if (!std::filesystem::exists(path_, ignored)) return false;
    Result<std::string> content = read_whole_file(path_);
    if (!content) return content.error();
    std::string_view bytes = *content;
    if (!bytes.starts_with(first_line)) return damaged(path_);
    bytes.remove_prefix(first_line.size());
    ArchiveReader reader(bytes);
    std::uint64_t sum = 0;
    reader(sum);
    if (!reader.good() || sum != checksum(bytes.substr(sizeof sum))) return damaged(path_);
    std::vector<std::string> names, values, dealt(1);
    std::vector<CheckpointPart> parts;
    reader(names, values, generation_, parts, dealt[0]);
    if (!reader.good() || reader.left() != 0 || names.size() != values.size()) return damaged(path_);
    CheckpointFacts kept;
    for (std::size_t i = 0; i < names.size(); ++i) kept.emplace_back(names[i], values[i]);
    if (const std::string differs = difference(kept, facts_); !differs.empty())
        return Error{ErrorCode::bad_input, "is of another solve: " + differs, path_,
                     "run as before, or without --resume to begin anew"};
    *content = {};
    for (std::size_t p = 1; p <= parts.size(); ++p) {
        Result<std::string> part = read_checkpoint_part(path_, generation_, p, parts[p - 1]);
        if (!part) return part.error();
        dealt.push_back(std::move(*part));
    }
    state_ = put_together(dealt);
    if (state_.empty()) return damaged(path_);
    return true;
}

bool CheckpointFile::is_due() const {
    return as_first(watch_.seconds() >= every_);
}

void CheckpointFile::keep(std::string dealt) {
    struct Written {
        CheckpointPart part;
        bool is_whole = true;
    };
    if (is_first_process()) generation_ = std::max(generation_, last_checkpoint_generation(path_)) + 1;
    generation_ = as_first(generation_);
    std::vector<Written> all(processes());
    Written& own = all[own_process()];
    if (!is_first_process()) {
        own.part = {dealt.size(), checksum(dealt)};
        own.is_whole = static_cast<bool>(write_file(checkpoint_part_path(path_, generation_, own_process()), dealt));
    }
    exchange_values(
        all.size(), 1, [&](std::size_t p) -> Written& { return all[p]; }, "checkpoint");
    written_ = by_first([&]() -> Result<void> {
        std::vector<CheckpointPart> parts;
        for (std::size_t p = 1; p < all.size(); ++p) {
            if (!all[p].is_whole)
                return Error{ErrorCode::cannot_write, fmt::format("cannot be written by process {}", p),
                             checkpoint_part_path(path_, generation_, p), ""};
            parts.push_back(all[p].part);
        }
        return write(std::move(parts), std::move(dealt));
    });
    // Remove the parts of the previous checkpoint on success, or those of the failed one.
    if (is_first_process())
        remove_checkpoint_parts(path_, written_ ? 0 : generation_, written_ ? generation_ : generation_ + 1);
    watch_.restart();
}

/// Writes the main file, after all parts. `dealt` is the part of the first process.
Result<void> CheckpointFile::write(std::vector<CheckpointPart> parts, std::string dealt) const {
    std::vector<std::string> names, values;
    for (const auto& [name, value] : facts_) names.push_back(name), values.push_back(value);
    std::uint64_t generation = generation_;
    ArchiveWriter writer;
    writer(names, values, generation, parts, dealt);
    dealt.clear();
    const std::string body = writer.take();
    std::uint64_t sum = checksum(body);
    ArchiveWriter head;
    head(sum);
    Result<AtomicFile> file = AtomicFile::create(path_);
    if (!file) return file.error();
    file->write(first_line), file->write(head.take()), file->write(body);
    return file->commit();
}

void CheckpointFile::remove() const {
    if (!is_first_process()) return;
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
    remove_checkpoint_parts(path_, 0, std::numeric_limits<std::uint64_t>::max());
}

}  // namespace exitance
