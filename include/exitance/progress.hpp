#pragma once

#include <memory>
#include <string_view>

namespace exitance::api {

/// Receives progress and messages of long work; derive a class from it. All calls come from the thread that called the
/// library. They must not throw, and must not call the library.
class Progress {
  public:
    virtual ~Progress();

    /// A phase begins: "mesh", "solve", "gather", ...
    virtual void phase(std::string_view name);
    /// Reports that `fraction`, in [0, 1], of the current phase is done; `detail` is a few words or empty.
    virtual void advance(double fraction, std::string_view detail);
    /// Reports an intermediate result.
    virtual void note(std::string_view message);
    /// Reports a problem that the user should see, once.
    virtual void warn(std::string_view message);
};

/// A request to stop long work, which checks it about ten times per second and then returns the result so far, or an
/// error of code `limit`. Pass one to one call at a time.
class StopRequest {
  public:
    StopRequest();
    ~StopRequest();
    StopRequest(const StopRequest&) = delete;
    StopRequest& operator=(const StopRequest&) = delete;

    /// Requests the stop. Any thread and any signal handler may call it.
    void request() noexcept;
    /// True after request().
    bool requested() const noexcept;

    struct State;
    /// For the library.
    State& state() { return *state_; }

  private:
    std::unique_ptr<State> state_;
};

/// Receiver of progress and source of stop requests of long work. Both may be null. They must outlive the call.
struct Control {
    Progress* progress = nullptr;
    StopRequest* stop = nullptr;
};

/// Sets the number of threads for all later calls; 0 means all cores, which is the default. Results do not depend on
/// it, to the last bit.
void set_threads(int count);

}  // namespace exitance::api
