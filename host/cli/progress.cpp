#include "cli/progress.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <unistd.h>

#include <vitrail/core/error.h>

#include "cli/verb.h"

namespace vitrail::cli {

namespace {

volatile std::sig_atomic_t interrupts = 0;

}  // namespace

void catchInterrupts() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupts = 1; };
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigaction(SIGINT, &action, nullptr);
}

void stopIfInterrupted() {
    if (interrupts) throw Error(ErrorCode::cancelled, {"interrupted; nothing was written", "", "", ""});
}

bool ProgressBar::show(const std::string& step, double fraction) {
    static const bool terminal = ::isatty(STDERR_FILENO) == 1;
    const double now = sinceStartMs();
    if (interrupts) return false;
    if (!terminal || now < 500 || (drawn_ && now - drawnMs_ < 100)) return true;
    constexpr int kWidth = 30;
    std::string bar(kWidth, '-');
    if (fraction >= 0) {
        const int done = static_cast<int>(fraction * kWidth);
        for (int i = 0; i < done && i < kWidth; ++i) bar[static_cast<std::size_t>(i)] = '#';
    } else {
        const int at = static_cast<int>(now / 100) % (kWidth - 4);
        for (int i = at; i < at + 4; ++i) bar[static_cast<std::size_t>(i)] = '#';
    }
    std::fprintf(stderr, "\r\033[K[%s] ", bar.c_str());
    if (fraction >= 0) std::fprintf(stderr, "%3.0f %% ", 100 * fraction);
    std::fprintf(stderr, "%s", step.c_str());
    std::fflush(stderr);
    drawn_ = true;
    drawnMs_ = now;
    return true;
}

void ProgressBar::clear() {
    if (!drawn_) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    drawn_ = false;
}

std::function<bool(const Progress&)> ProgressBar::callback() {
    return [this](const Progress& progress) { return show(progress.step, progress.fraction); };
}

void ProgressBar::leave() {
    clear();
    std::fputs("vitrail: interrupted; nothing was written\n", stderr);
    std::_Exit(130);
}

}  // namespace vitrail::cli
