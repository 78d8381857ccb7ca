#pragma once

#include <span>
#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// A value of an option or input that may name a file.
struct NamedFile {
    std::string option;  ///< Name of the option or input.
    std::string path;
    bool is_output = false;
};

/// Error (usage) if an output is also named by another option or input, so that writing it would destroy an input or
/// another output of the run. Links are followed. Folders and devices may be named several times.
Result<void> check_named_files(std::span<const NamedFile> files);

/// Error (usage) if `verb` cannot write its solution to `path`: standard output, or a name with an ending that is not
/// ".h5", which may be that of a scene's file.
Result<void> check_solution_name(const std::string& verb, const std::string& path);

/// Error (usage) if writing `output` would replace a scene's file. `scene_file`: see find_scene_file().
Result<void> check_scene_is_kept(const std::string& output, const std::string& scene_file);

}  // namespace exitance
