#include "exitance/io/scenes/radiance/radiance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <list>
#include <unordered_map>

#include "exitance/io/files/scene_program.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/scenes/radiance/rad_box_command.hpp"
#include "exitance/io/scenes/radiance/rad_command.hpp"
#include "exitance/io/scenes/radiance/rad_scene.hpp"
#include "exitance/io/scenes/radiance/rad_sky_command.hpp"
#include "exitance/io/scenes/radiance/xform.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_copies = 100'000, max_depth = 16;

std::string folder_of(const std::string& path) {
    return std::filesystem::path(path).parent_path().string();
}

class RadianceReader {
  public:
    RadianceReader(std::span<const std::string> paths, const LoadOptions& options) : paths_(paths), options_(options) {}
    ReadScene read();

  private:
    void read_text(std::string_view text, const RadCall& call);
    void run_command(const std::string& command, int line, const RadCall& call);
    void read_copies(const std::vector<CommandWords>& stages, int line, const RadCall& call);
    /// A text, and the transforms with which it is repeated.
    struct Copied {
        const std::string* name = nullptr;
        const std::string* text = nullptr;
        int first_line = 0, command_line = 0;
        std::string prefix, material;
        std::vector<Affine> copies{1};
    };
    Result<Copied> copied_by(const std::vector<CommandWords>& stages, int line, const RadCall& call);
    Result<void> add_file(const std::string& name, Copied& out);
    Result<void> add_output(std::span<const CommandWords> stages, int line, const RadCall& call, Copied& out);
    Result<std::string> sky_text(const CommandWords& words, const RadPlace& at);
    int first_line(const std::string& path, std::string_view text);

    std::span<const std::string> paths_;
    const LoadOptions& options_;
    std::string root_;  ///< Path of the root file being read: commands search files in its folder.
    ReadScene out_;
    RadFindings findings_;
    RadScene scene_{out_, findings_, root_};
    std::unordered_map<std::string, std::string> texts_;      ///< Files named in commands, each read once.
    std::list<std::pair<std::string, std::string>> outputs_;  ///< Description and output of commands.
    std::unordered_map<std::string, int> first_lines_;
    std::vector<const std::string*> open_;  ///< Names of the texts being read, to detect recursion.
    std::size_t copies_ = 0;
};

int RadianceReader::first_line(const std::string& path, std::string_view text) {
    const auto [at, is_new] = first_lines_.try_emplace(path);
    if (is_new) at->second = out_.lines.add(path, 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n')));
    return at->second;
}

Result<void> RadianceReader::add_file(const std::string& name, Copied& out) {
    const std::string path = beside(root_, name);
    auto text = texts_.find(path);
    if (text == texts_.end()) {
        Result<std::string> read = read_whole_file(path);
        if (!read)
            return Error{ErrorCode::bad_input, fmt::format("'{}' {}", shown(name), read.error().message), "", ""};
        scene_.count_bytes(read->size());
        text = texts_.emplace(path, std::move(*read)).first;
    }
    if (std::any_of(open_.begin(), open_.end(), [&](const std::string* open) { return *open == path; }))
        return Error{ErrorCode::bad_input, fmt::format("'{}' calls itself", shown(name)), "", ""};
    out.name = &text->first, out.text = &text->second, out.first_line = first_line(path, text->second);
    return {};
}

/// Returns the output of `!gensky` or `!gendaylit`; their warnings become findings.
Result<std::string> RadianceReader::sky_text(const CommandWords& words, const RadPlace& at) {
    Result<PrintedSky> printed = sky_command_output(words, options_.older_sky_programs);
    if (!printed) return printed.error();
    for (std::string& warning : printed->warnings) findings_.warning(at, std::move(warning));
    return std::move(printed->text);
}

/// Adds the output of a pipeline of programs.
Result<void> RadianceReader::add_output(std::span<const CommandWords> stages, int line, const RadCall& call,
                                        Copied& out) {
    const bool is_known = (is_sky_command(stages[0]) || is_box_command(stages[0])) && stages.size() == 1;
    if (!options_.run_commands && !is_known)
        return Error{ErrorCode::bad_input, fmt::format("the command '!{}' is not run", shown(stages[0][0])), "",
                     "--run-commands runs installed Radiance programs; or run it yourself, write its output to a file, "
                     "and name the file in a line '!xform FILE'"};
    const StopRequest never;
    std::string text;
    for (const CommandWords& words : stages) {
        Result<std::string> printed =
            is_known ? is_box_command(words) ? box_command_output(words) : sky_text(words, {*call.name, line})
                     : run_scene_program(words, text, folder_of(root_), options_.stop ? *options_.stop : never);
        // With --run-commands, the program itself handles options that are not supported here.
        if (is_known && !printed && options_.run_commands)
            printed = run_scene_program(words, text, folder_of(root_), options_.stop ? *options_.stop : never);
        if (!printed) return printed.error();
        text = std::move(*printed);
    }
    scene_.count_bytes(text.size());
    const auto& [name, kept] =
        outputs_.emplace_back(fmt::format("{}:{}: '!{}'", *call.name, line, stages[0][0]), std::move(text));
    out.name = &name, out.text = &kept;
    out.command_line = call.command_line > 0 ? call.command_line : call.first_line + line;
    return {};
}

/// Makes the copies of xform commands: a first xform with a file, and those at the end of a pipeline.
Result<RadianceReader::Copied> RadianceReader::copied_by(const std::vector<CommandWords>& stages, int line,
                                                         const RadCall& call) {
    Copied out;
    const auto multiply = [&](const Xform& xform) {
        std::vector<Affine> copies;
        for (const Affine& after : xform.copies)
            for (const Affine& before : out.copies) copies.push_back(after * before);
        out.copies = std::move(copies);
        if (!xform.name.empty()) out.prefix = shown(xform.name) + "." + out.prefix;
        if (!xform.material.empty()) out.material = xform.material;
    };
    std::size_t run = stages.size();
    std::vector<Xform> last;
    for (; run > 0 && stages[run - 1][0] == "xform"; --run) {
        Result<Xform> xform = parse_xform({stages[run - 1].begin() + 1, stages[run - 1].end()}, max_copies);
        if (!xform) return xform.error();
        if (xform->files.empty() != (run > 1))
            return Error{ErrorCode::bad_input,
                         run > 1 ? "xform has both a file and the output of a command to transform"
                                 : "xform has no file to transform",
                         "", ""};
        last.push_back(std::move(*xform));
    }
    const Result<void> added =
        run > 0 ? add_output(std::span(stages).first(run), line, call, out) : add_file(last.back().files[0], out);
    if (!added) return added.error();
    std::size_t copies = 1;
    for (const Xform& xform : last) copies = std::min(2 * max_copies, copies * xform.copies.size());
    copies_ += copies;
    if (copies_ > max_copies)
        return Error{ErrorCode::bad_input, fmt::format("there are more than {} copies", max_copies), "", ""};
    for (auto xform = last.rbegin(); xform != last.rend(); ++xform) multiply(*xform);
    return out;
}

void RadianceReader::run_command(const std::string& command, int line, const RadCall& call) {
    const RadPlace at{*call.name, line};
    if (call.depth >= max_depth)
        return findings_.error(at, fmt::format("files include each other {} levels deep", max_depth));
    const Result<std::vector<CommandWords>> stages = parse_command(command);
    if (!stages) return findings_.error(at, stages.error().message, stages.error().hint);
    const CommandWords& first = stages->front();
    const Result<Xform> xform =
        first[0] == "xform" ? parse_xform({first.begin() + 1, first.end()}, max_copies) : Result<Xform>(Xform());
    if (!xform || xform->files.size() < 2) return read_copies(*stages, line, call);
    for (const std::string& file : xform->files) {
        std::vector<CommandWords> of_one = *stages;
        of_one.front() = {"xform"};
        of_one.front().insert(of_one.front().end(), xform->options.begin(), xform->options.end());
        of_one.front().push_back(file);
        read_copies(of_one, line, call);
    }
}

void RadianceReader::read_copies(const std::vector<CommandWords>& stages, int line, const RadCall& call) {
    const Result<Copied> copied = copied_by(stages, line, call);
    if (!copied) return findings_.error({*call.name, line}, copied.error().message, copied.error().hint);
    for (const Affine& copy : copied->copies) {
        if (findings_.failed()) return;  // the first copy has reported the file's errors
        read_text(*copied->text, {copied->name, call.to_world * copy, call.prefix + copied->prefix,
                                  call.material.empty() ? copied->material : call.material, copied->first_line,
                                  copied->command_line, call.depth + 1});
    }
}

void RadianceReader::read_text(std::string_view text, const RadCall& call) {
    open_.push_back(call.name);
    RadWords words(text);
    constexpr std::size_t max_errors = 100;
    while (findings_.error_count() <= max_errors) {
        const std::optional<std::string_view> word = words.next();
        if (!word && words.is_open_quote())
            findings_.error({*call.name, words.line()}, "a quoted word does not end on its line");
        if (!word) break;
        if (word->starts_with('!') && !words.was_quoted()) {
            const int line = words.line();
            run_command(std::string(word->substr(1)) + words.rest_of_command(), line, call);
            continue;
        }
        RadPrimitive p;
        p.modifier = *word;
        if (const auto fault = read_primitive(words, p)) {
            findings_.error({*call.name, fault->line}, fault->message);
            break;  // the beginning of the next primitive is unknown
        }
        if (findings_.failed() && call.depth > 0) break;
        scene_.take(std::move(p), call);
    }
    open_.pop_back();
}

ReadScene RadianceReader::read() {
    out_.description.file = paths_.front();
    for (const std::string& path : paths_) {
        root_ = path;
        const Result<std::string> text = read_whole_file(path);
        if (!text) {
            findings_.error({path, 0}, text.error().message);
            break;
        }
        scene_.count_bytes(text->size());
        read_text(*text, {&path, {}, "", "", first_line(path, *text), 0, 0});
        if (findings_.failed()) break;  // stop: later files may use names that the failed file should have defined
    }
    scene_.finish();
    out_.findings = findings_.take();
    if (scene_.opened())
        out_.findings.push_back(
            {Finding::Kind::warning, paths_.front(), 0,
             "an emitting sphere around everything else is read as a uniform sky, infinitely far away", ""});
    return std::move(out_);
}

}  // namespace

ReadScene read_radiance(std::span<const std::string> paths, const LoadOptions& options) {
    return RadianceReader(paths, options).read();
}

ReadScene read_radiance(const std::string& path) {
    return read_radiance(std::span(&path, 1), {});
}

}  // namespace exitance
