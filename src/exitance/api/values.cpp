#include "exitance/api/inside.hpp"
#include "exitance/base/parallel.hpp"

namespace exitance::api {

template <std::size_t n>
const char LibraryOfBands<n>::linked = 0;

template struct LibraryOfBands<bands>;

std::string Error::text() const {
    std::string out = where.empty() ? message : where + ": " + message;
    if (!hint.empty()) out += " (" + hint + ")";
    return out;
}

Failure::Failure(Error error) : std::runtime_error(error.text()), error_(std::move(error)) {}
Failure::~Failure() = default;

void fail(const Error& error) {
    throw Failure(error);
}

Progress::~Progress() = default;
void Progress::phase(std::string_view) {}
void Progress::advance(double, std::string_view) {}
void Progress::note(std::string_view) {}
void Progress::warn(std::string_view) {}

StopRequest::StopRequest() : state_(std::make_unique<State>()) {}
StopRequest::~StopRequest() = default;
void StopRequest::request() noexcept {
    state_->request.interrupt();
}
bool StopRequest::requested() const noexcept {
    return state_->request.interrupted();
}

namespace {

int chosen_threads = 0;  ///< Argument of set_threads(); guarded by turns().

}  // namespace

void set_threads(int count) {
    const std::lock_guard turn(turns());
    chosen_threads = count > 0 ? count : 0;
    exitance::set_threads(chosen_threads);
}

ThreadsOfCall::ThreadsOfCall(int count) : is_set_(count > 0) {
    if (is_set_) exitance::set_threads(count);
}
ThreadsOfCall::~ThreadsOfCall() {
    if (is_set_) exitance::set_threads(chosen_threads);
}

}  // namespace exitance::api
