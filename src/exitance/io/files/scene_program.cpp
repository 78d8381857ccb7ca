#include "exitance/io/files/scene_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "exitance/io/files/child_process.hpp"
#include "exitance/io/files/text_lines.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_scene_bytes = std::size_t{256} << 20;
constexpr int poll_ms = 50;  ///< Milliseconds between checks of the stop request.

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

Error bad(std::string message, std::string hint = "") {
    return {ErrorCode::bad_input, std::move(message), "", std::move(hint)};
}

/// Both ends of a pipe, closed by the destructor.
struct Pipe {
    std::array<int, 2> end{-1, -1};
    bool open() { return ::pipe2(end.data(), O_CLOEXEC) == 0; }
    void close(std::size_t i) {
        if (end[i] >= 0) ::close(end[i]);
        end[i] = -1;
    }
    ~Pipe() { close(0), close(1); }
};

/// Reads from a pipe until it is closed. Returns false if a stop was requested or the output is too long.
bool read_all(int from, const StopRequest& stop, std::string& out) {
    std::array<char, 65536> block;
    while (out.size() <= max_scene_bytes && !stop.requested()) {
        pollfd waiting{from, POLLIN, 0};
        if (::poll(&waiting, 1, poll_ms) <= 0) continue;
        const ssize_t n = ::read(from, block.data(), block.size());
        if (n == 0) return true;
        if (n < 0 && errno != EINTR && errno != EAGAIN) return true;
        if (n > 0) out.append(block.data(), static_cast<std::size_t>(n));
    }
    return false;
}

std::string first_line(std::FILE* file) {
    std::rewind(file);
    std::array<char, 200> text{};
    if (!std::fgets(text.data(), text.size(), file)) return "";
    std::string line(text.data());
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
    return line;
}

}  // namespace

bool is_scene_program(const std::string& name) {
    static constexpr std::array known = {"genbox",    "genprism", "gensurf",   "genrev",  "genworm",   "genblinds",
                                         "genclock",  "gensky",   "gendaylit", "xform",   "replmarks", "genbranch",
                                         "obj2rad",   "mgf2rad",  "nff2rad",   "thf2rad", "tmesh2rad", "arch2rad",
                                         "lampcolor", "cnt",      "rcalc",     "cat",     "echo"};
    return std::find(known.begin(), known.end(), name) != known.end();
}

Result<std::string> run_scene_program(const std::vector<std::string>& words, const std::string& input,
                                      const std::string& folder, const StopRequest& stop) {
    const std::string name = words.empty() ? "" : words[0];
    if (!is_scene_program(name))
        return bad(fmt::format("'{}' is not a Radiance program that makes scenes", shown(name)),
                   "other programs are not run");
    if (!is_program(name)) return bad(fmt::format("the program '{}' is not installed", name), "it comes with Radiance");
    const File in(std::tmpfile(), &std::fclose), err(std::tmpfile(), &std::fclose);
    Pipe out;
    if (!in || !err || !out.open()) return bad(fmt::format("'{}' cannot be run: {}", name, std::strerror(errno)));
    if (std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() || std::fflush(in.get()) != 0)
        return bad(fmt::format("'{}' cannot be given its input: {}", name, std::strerror(errno)));
    std::rewind(in.get());
    ChildProcess child;
    if (!child.start(words, ::fileno(in.get()), out.end[1], ::fileno(err.get()), folder))
        return bad(fmt::format("'{}' cannot be run: {}", name, std::strerror(errno)));
    out.close(1);
    std::string text;
    const bool whole = read_all(out.end[0], stop, text);
    bool ended = false;
    while (whole && !stop.requested() && !(ended = child.has_ended())) ::poll(nullptr, 0, 1);
    if (stop.requested() && !ended)
        return Error{ErrorCode::limit, fmt::format("'{}' was still running when a stop was requested", name), "", ""};
    if (!whole) return bad(fmt::format("'{}' prints more than {} MB", name, max_scene_bytes >> 20));
    if (!child.succeeded()) return bad(fmt::format("'{}' fails: {}", name, shown(first_line(err.get()))));
    return text;
}

}  // namespace exitance
