#include "exitance/io/files/scene_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <sstream>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {
namespace {

constexpr std::size_t most_output = std::size_t{256} << 20;
constexpr int glance = 50;  ///< Milliseconds between looks at the stop request.

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

Error bad(std::string message, std::string hint = "") {
    return {ErrorCode::bad_input, std::move(message), "", std::move(hint)};
}

bool is_executable(const std::string& name) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (!folder.empty() && ::access((folder + "/" + name).c_str(), X_OK) == 0) return true;
    return false;
}

/// A pipe's two ends, closed when it goes.
struct Pipe {
    std::array<int, 2> end{-1, -1};
    bool open() { return ::pipe2(end.data(), O_CLOEXEC) == 0; }
    void close(std::size_t i) {
        if (end[i] >= 0) ::close(end[i]);
        end[i] = -1;
    }
    ~Pipe() { close(0), close(1); }
};

/// A process group that does not outlive this object.
class Child {
  public:
    ~Child() {
        if (process_ > 0) end();
    }
    /// It dies with this program, whichever way that ends.
    bool start(const std::vector<std::string>& words, int in, int out, int err, const std::string& folder) {
        std::vector<std::string> copies = words;
        std::vector<char*> pointers;
        for (std::string& word : copies) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        const pid_t parent = ::getpid();
        process_ = ::fork();
        if (process_ > 0) ::setpgid(process_, process_);  // as the child does itself: whoever comes first
        if (process_ != 0) return process_ > 0;
        // Nothing but system calls from here on: other threads may have held any lock.
        ::setpgid(0, 0);
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) ::signal(signal, SIG_DFL);
        if (::getppid() != parent || ::dup2(in, 0) < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0 ||
            (!folder.empty() && ::chdir(folder.c_str()) != 0))
            ::_exit(126);
        ::execvp(pointers[0], pointers.data());
        ::_exit(127);
    }
    bool has_ended() { return ::waitpid(process_, &status_, WNOHANG) == process_ && (process_ = -1, true); }
    bool succeeded() const { return WIFEXITED(status_) && WEXITSTATUS(status_) == 0; }

  private:
    void end() {
        ::kill(-process_, SIGKILL), ::kill(process_, SIGKILL);
        ::waitpid(process_, &status_, 0);
    }
    pid_t process_ = -1;
    int status_ = 0;
};

/// What comes through a pipe until it is closed; false where a stop was asked for, or it is too much.
bool read_all(int from, const StopRequest& stop, std::string& out) {
    std::array<char, 65536> block;
    while (out.size() <= most_output && !stop.requested()) {
        pollfd waiting{from, POLLIN, 0};
        if (::poll(&waiting, 1, glance) <= 0) continue;
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
        return bad(fmt::format("'{}' is no program of Radiance's that makes scenes", shown(name)),
                   "others are not run");
    if (!is_executable(name))
        return bad(fmt::format("the program '{}' is not installed", name), "it comes with Radiance");
    const File in(std::tmpfile(), &std::fclose), err(std::tmpfile(), &std::fclose);
    Pipe out;
    if (!in || !err || !out.open()) return bad(fmt::format("'{}' cannot be run: {}", name, std::strerror(errno)));
    if (std::fwrite(input.data(), 1, input.size(), in.get()) != input.size() || std::fflush(in.get()) != 0)
        return bad(fmt::format("'{}' cannot be given its input: {}", name, std::strerror(errno)));
    std::rewind(in.get());
    Child child;
    if (!child.start(words, ::fileno(in.get()), out.end[1], ::fileno(err.get()), folder))
        return bad(fmt::format("'{}' cannot be run: {}", name, std::strerror(errno)));
    out.close(1);
    std::string text;
    const bool whole = read_all(out.end[0], stop, text);
    bool ended = false;
    while (whole && !stop.requested() && !(ended = child.has_ended())) ::poll(nullptr, 0, 1);
    if (stop.requested() && !ended)
        return Error{ErrorCode::limit, fmt::format("'{}' was still running when a stop was asked for", name), "", ""};
    if (!whole) return bad(fmt::format("'{}' prints more than {} MB", name, most_output >> 20));
    if (!child.succeeded()) return bad(fmt::format("'{}' fails: {}", name, shown(first_line(err.get()))));
    return text;
}

}  // namespace exitance
