#include "exitance/io/scenes/scene_file.hpp"

#include <filesystem>
#include <fstream>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/gltf.hpp"
#include "exitance/io/scenes/obj.hpp"
#include "exitance/io/scenes/radiance.hpp"
#include "exitance/scene/findings.hpp"

namespace exitance {
namespace {

CheckedScene refused(ErrorCode code, const std::string& path, std::string message, std::string hint) {
    return {Error{code, message, path, hint}, {{Finding::Kind::error, path, 0, message, hint}}};
}

/// Findings of the reader and of the checks together. A file with errors is still looked at in full, but not warned
/// about light that may be among what could not be read.
CheckedScene checked(ReadScene read) {
    const bool broken = has_errors(read.findings);
    if (broken && read.description.faces.empty()) {
        sort_findings(read.findings);
        Error first = error_of(read.findings);
        return {std::move(first), std::move(read.findings)};
    }
    CheckedScene out = make_scene(std::move(read.description));
    if (broken) std::erase_if(out.findings, [](const Finding& f) { return f.kind == Finding::Kind::warning; });
    out.findings.insert(out.findings.begin(), read.findings.begin(), read.findings.end());
    sort_findings(out.findings);
    if (broken) out.scene = error_of(out.findings);
    return out;
}

/// Repairs become errors.
CheckedScene refuse_repairs(CheckedScene scene) {
    for (Finding& finding : scene.findings)
        if (finding.kind == Finding::Kind::repair) finding.kind = Finding::Kind::error;
    sort_findings(scene.findings);
    if (has_errors(scene.findings)) scene.scene = error_of(scene.findings);
    return scene;
}

/// For files under other names: the container's first bytes.
bool looks_like_gltf(const std::string& path) {
    char magic[4] = {};
    std::ifstream(path, std::ios::binary).read(magic, sizeof magic);
    return std::string_view(magic, sizeof magic) == "glTF";
}

using Reader = ReadScene (*)(const std::string& path);

Reader reader_of(const std::string& path) {
    const std::string end = ending(path);
    if (end == ".obj") return read_obj;
    if (end == ".rad") return read_radiance;
    if (end == ".gltf" || end == ".glb" || looks_like_gltf(path)) return read_gltf;
    return nullptr;
}

}  // namespace

CheckedScene load_scene(const std::string& path, Faults faults) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored))
        return refused(ErrorCode::cannot_read, path, "there is no such file", "");
    if (const Reader read = reader_of(path))
        return faults == Faults::refuse ? refuse_repairs(checked(read(path))) : checked(read(path));
    return refused(ErrorCode::bad_input, path, "this kind of scene file is not known",
                   "known endings: .obj, .gltf, .glb, .rad");
}

SceneDescription read_description(const std::string& path) {
    const Reader read = reader_of(path);
    return read ? read(path).description : SceneDescription();
}

}  // namespace exitance
