#include "exitance/io/files/write_error.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace exitance {

Error cannot_write(const std::string& path, int error) {
    std::string hint;
    if (error == ENOENT) hint = "make the folder first";
    if (error == EISDIR) hint = "name a file in it";
    if (error == ENOTDIR || error == EEXIST) hint = "a file has the name of one of its folders: choose another folder";
    if (error == ENOSPC || error == EDQUOT) hint = "free some space, or write to another disk";
    if (error == ENAMETOOLONG) hint = "choose a shorter name: most file systems allow 255 bytes";
    if (error == EACCES || error == EPERM || error == EROFS)
        hint = "check the permissions of the folder, or write into another one";
    return {ErrorCode::cannot_write, std::string("cannot be written: ") + std::strerror(error), path, hint};
}

Result<void> make_folder(const std::string& path) {
    std::error_code failure;
    std::filesystem::create_directories(path, failure);
    if (failure) return Error{ErrorCode::cannot_write, "cannot be made: " + failure.message(), path, ""};
    return {};
}

}  // namespace exitance
