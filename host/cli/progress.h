// cli/progress.h: a bar on a terminal, and Ctrl-C. The first Ctrl-C asks the running step to stop, the second ends the program at once.
#pragma once
#include <functional>
#include <future>
#include <string>

#include <vitrail/core/queue.h>

namespace vitrail::cli {

void catchInterrupts();
/// Throws Error (cancelled) after a Ctrl-C.
void stopIfInterrupted();

/// Says on standard error, when that is a terminal, what goes on; at most ten times a second, not in the first half second, and gone when the
/// work is done.
class ProgressBar {
public:
    ~ProgressBar() { clear(); }

    /// False after a Ctrl-C. A negative fraction: nobody knows how far.
    bool show(const std::string& step, double fraction);
    void clear();
    /// For Queue::setProgress; must not outlive the bar.
    std::function<bool(const Progress&)> callback();

    /// The result of `work`, which must only compute: a Ctrl-C does not wait for it but ends the program.
    template <class Work>
    auto wait(const std::string& step, Work work) {
        auto result = std::async(std::launch::async, std::move(work));
        while (result.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
            if (!show(step, -1)) leave();
        }
        return result.get();
    }

private:
    [[noreturn]] void leave();

    bool drawn_ = false;
    double drawnMs_ = 0;
};

}  // namespace vitrail::cli
