// vitrail/deform/deformed.h: what a deformation returns: its times.
#pragma once
#include <vitrail/core/report.h>

#include <memory>

namespace vitrail {
inline namespace v0 {

namespace detail {
struct Record;
}

/// May be dropped: the deformation itself is enqueued.
class Deformed {
public:
    explicit Deformed(std::shared_ptr<detail::Record> record) : record_(std::move(record)) {}
    /// Waits for the deformation's commands.
    CallReport report() const;

private:
    std::shared_ptr<detail::Record> record_;
};

}  // namespace v0
}  // namespace vitrail
