// Calls tinygltf, which parses the JSON, base64 and the container.
#include "exitance/io/scenes/gltf/gltf_parse.hpp"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <cstring>
#include <filesystem>
#include <utility>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/gltf/json_shape.hpp"

namespace exitance {
namespace {

/// Files in the scene's folder, and a limit on the bytes that may be read from them.
struct Folder {
    std::string path;
    std::uint64_t bytes_left = std::uint64_t(4) << 30;
};

/// Restricts tinygltf to the scene's folder: tinygltf would also search the current folder.
bool exists(const std::string& path, void* user) {
    const auto& folder = *static_cast<Folder*>(user);
    std::error_code ignored;
    return path.starts_with(folder.path) && std::filesystem::is_regular_file(path, ignored);
}
std::string as_it_is(const std::string& path, void*) {
    return path;
}
bool read_bytes(std::vector<unsigned char>* out, std::string* error, const std::string& path, void* user) {
    auto& folder = *static_cast<Folder*>(user);
    std::error_code ignored;
    const auto size = std::filesystem::file_size(path, ignored);
    if (ignored || size > folder.bytes_left) return error->append("is too large"), false;
    folder.bytes_left -= size;
    const Result<std::string> text = read_whole_file(path);
    if (!text) return *error = text.error().message, false;
    out->assign(text->begin(), text->end());
    return true;
}
bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
}
/// Sets the function for the size of a file, which versions of tinygltf from 2.9 on require and earlier ones do not
/// have.
template <class Callbacks>
void add_size_function(Callbacks& callbacks) {
    if constexpr (requires { callbacks.GetFileSizeInBytes; })
        callbacks.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string& path, void*) {
            std::error_code failure;
            *size = std::filesystem::file_size(path, failure);
            return !failure;
        };
}
/// Stores a picture undecoded. Pictures in buffers stay there, since their offsets have not been checked.
bool keep_picture(tinygltf::Image* image, const int, std::string*, std::string*, int, int, const unsigned char* bytes,
                  int size, void*) {
    if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
    return true;
}

}  // namespace

std::optional<Error> parse_gltf(const std::string& bytes, const std::string& path, tinygltf::Model& out) {
    const auto bad = [&](std::string message, std::string hint = "") {
        return Error{ErrorCode::bad_input, std::move(message), path, std::move(hint)};
    };
    constexpr std::size_t header = 20;
    const bool binary = bytes.starts_with("glTF");
    std::string_view json = bytes;
    if (bytes.size() >= (std::uint64_t(1) << 32)) return bad("is of 4 GiB or more, which glTF does not allow");
    if (binary) {
        std::uint32_t length = 0, version = 0;
        if (bytes.size() < header) return bad("ends within its header");
        std::memcpy(&version, bytes.data() + 4, 4), std::memcpy(&length, bytes.data() + 12, 4);
        if (version != 2) return bad(fmt::format("is a binary glTF of version {}; version 2 is read", version));
        if (length > bytes.size() - header)
            return bad(
                fmt::format("has a JSON chunk of {} bytes, but only {} are left", length, bytes.size() - header));
        json = json.substr(header, length);
    }
    const JsonShape shape = shape_of_json(json);
    if (shape.depth > 100)
        return bad(fmt::format("has JSON that is nested {} levels deep, more than 100", shape.depth));
    if (binary && shape.buffers * (bytes.size() - header - json.size()) > 4 * bytes.size() + (std::size_t(32) << 20))
        return bad(fmt::format("has {} buffers, too many for its size", shape.buffers));

    Folder folder{std::filesystem::path(path).parent_path().string()};
    if (folder.path.empty()) folder.path.assign(1, '.');
    std::string problem, remark;
    bool done = false;
    try {
        tinygltf::TinyGLTF loader;
        tinygltf::FsCallbacks callbacks{};
        callbacks.FileExists = exists, callbacks.ExpandFilePath = as_it_is;
        callbacks.ReadWholeFile = read_bytes, callbacks.WriteWholeFile = write_nothing;
        callbacks.user_data = &folder;
        add_size_function(callbacks);
        loader.SetFsCallbacks(callbacks);
        loader.SetImageLoader(keep_picture, nullptr);
        const auto size = static_cast<unsigned>(bytes.size());
        done = binary ? loader.LoadBinaryFromMemory(&out, &problem, &remark,
                                                    reinterpret_cast<const unsigned char*>(bytes.data()), size,
                                                    folder.path)
                      : loader.LoadASCIIFromString(&out, &problem, &remark, bytes.data(), size, folder.path);
    } catch (const std::exception& e) {
        done = false, problem = e.what();
    }
    // Compressed meshes have accessors without data, which make tinygltf fail first.
    for (const auto& [extension, name] : {std::pair{"KHR_draco_mesh_compression", "Draco"},
                                          {"EXT_meshopt_compression", "meshopt"},
                                          {"KHR_meshopt_compression", "meshopt"}})
        if (!done && bytes.find(extension) != bytes.npos)
            return bad(fmt::format("has meshes that are compressed ({}), which is not supported", name),
                       "export it again without compression");
    if (!done) {
        const std::string first = problem.substr(0, problem.find('\n'));
        return bad(first.empty() ? "is no glTF" : fmt::format("cannot be read as glTF: {}", shown(first)),
                   first.starts_with("File not found") ? "put the files that it names in the same folder" : "");
    }
    if (!out.asset.version.starts_with("2"))
        return bad(fmt::format("is glTF of version '{}'; version 2 is read", shown(out.asset.version)));
    return std::nullopt;
}

}  // namespace exitance
