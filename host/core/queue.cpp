#include <vitrail/core/queue.h>

#include <algorithm>
#include <cstdlib>
#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "core/call.h"
#include "core/opencl.h"

namespace vitrail {
inline namespace v0 {

namespace detail {

namespace {

double milliseconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

double eventMs(const cl::Event& event) {
    return 1e-6 *
           static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() - event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
}

void note(QueueState& queue, std::vector<cl::Event> Record::*list, const cl::Event& event) {
    const auto now = std::chrono::steady_clock::now();
    for (const std::shared_ptr<Record>& record : queue.records) {
        if (record->kernels.empty() && record->uploads.empty()) record->firstEnqueue = now;
        ((*record).*list).push_back(event);
    }
}

constexpr std::uint64_t kPage = 2 << 20, kPagedLeast = 16 << 20;

/// Large memory of a CPU lies in pages of 2 MiB where the system has them: kernels that set bits here and there miss the TLB less
/// often.
cl::Buffer makeBuffer(const DeviceState& device, std::uint64_t bytes) {
#if defined(__linux__)
    if (device.info.cpu && bytes >= kPagedLeast) {
        std::unique_ptr<void, decltype(&std::free)> host(std::aligned_alloc(kPage, (bytes + kPage - 1) / kPage * kPage), &std::free);
        if (host != nullptr) {
            madvise(host.get(), bytes, MADV_HUGEPAGE);
            cl::Buffer buffer(device.context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, host.get());
            buffer.setDestructorCallback([](cl_mem, void* memory) { std::free(memory); }, host.get());
            (void)host.release();
            return buffer;
        }
    }
#endif
    return cl::Buffer(device.context, CL_MEM_READ_WRITE, bytes);
}

}  // namespace

void Pool::trim() {
    std::vector<std::unique_ptr<Memory>> going;
    {
        const std::lock_guard lock(mutex);
        going.swap(free);
    }
    for (const auto& memory : going) device->counters.deviceBytes -= memory->bytes;
}

std::uint64_t Pool::freeBytes() {
    const std::lock_guard lock(mutex);
    std::uint64_t sum = 0;
    for (const auto& memory : free) sum += memory->bytes;
    return sum;
}

std::shared_ptr<Memory> takeMemory(QueueState& queue, std::uint64_t bytes, std::string_view purpose) {
    DeviceState& device = *queue.device;
    const std::shared_ptr<Pool> pool = queue.pool;
    const auto wrap = [&pool](std::unique_ptr<Memory> memory) {
        return std::shared_ptr<Memory>(memory.release(), [pool](Memory* returned) {
            const std::lock_guard lock(pool->mutex);
            pool->free.emplace_back(returned);
        });
    };
    bytes = (bytes + 255) / 256 * 256;
    {
        const std::lock_guard lock(pool->mutex);
        auto best = pool->free.end();
        for (auto it = pool->free.begin(); it != pool->free.end(); ++it)
            if ((*it)->bytes >= bytes && (*it)->bytes <= 2 * bytes && (best == pool->free.end() || (*it)->bytes < (*best)->bytes))
                best = it;
        if (best != pool->free.end()) {
            std::unique_ptr<Memory> memory = std::move(*best);
            pool->free.erase(best);
            return wrap(std::move(memory));
        }
    }
    const std::string where = "device: " + device.text();
    if (bytes > device.info.maxBufferBytes)
        throw Error(ErrorCode::outOfMemory, {std::string(purpose) + " needs " + bytesText(bytes) + "; this device allows " +
                                                 bytesText(device.info.maxBufferBytes) + " in one buffer",
                                             where, "", "a coarser grid"});
    if (device.counters.deviceBytes + bytes > device.memoryLimit) pool->trim();
    if (device.counters.deviceBytes + bytes > device.memoryLimit)
        throw Error(ErrorCode::outOfMemory,
                    {std::string(purpose) + " needs " + bytesText(bytes) + " more; " + bytesText(device.counters.deviceBytes) +
                         " of the limit of " + bytesText(device.memoryLimit) + " are in use",
                     where, "", "a coarser grid, or a higher limit (VITRAIL_MEMORY_LIMIT, Device::setMemoryLimit)"});
    return guarded(&device, "taking device memory", [&] {
        auto memory = std::make_unique<Memory>();
        memory->buffer = makeBuffer(device, bytes);
        memory->bytes = bytes;
        ++device.counters.allocations;
        const std::uint64_t now = device.counters.deviceBytes += bytes;
        std::uint64_t peak = device.counters.peakDeviceBytes;
        while (peak < now && !device.counters.peakDeviceBytes.compare_exchange_weak(peak, now)) {
        }
        return wrap(std::move(memory));
    });
}

std::shared_ptr<QueueState> makeQueueState(std::shared_ptr<DeviceState> device, const cl::CommandQueue& queue) {
    auto state = std::make_shared<QueueState>();
    state->device = std::move(device);
    state->queue = queue;
    state->pool = std::make_shared<Pool>(state->device);
    return state;
}

void readBytes(Queue& queue, const Memory& memory, std::size_t offset, void* to, std::size_t bytes) {
    QueueState& state = *queue.state();
    guarded(state.device.get(), "reading from the device",
            [&] { state.queue.enqueueReadBuffer(memory.buffer, CL_TRUE, offset, bytes, to); });
    ++state.device->counters.readBacks;
    state.device->counters.readBackBytes += bytes;
}

void writeBytes(Queue& queue, Memory& memory, std::size_t offset, const void* from, std::size_t bytes) {
    QueueState& state = *queue.state();
    guarded(state.device.get(), "writing to the device", [&] {
        cl::Event event;
        state.queue.enqueueWriteBuffer(memory.buffer, CL_TRUE, offset, bytes, from, nullptr, &event);
        note(state, &Record::uploads, event);
    });
    ++state.device->counters.uploads;
    state.device->counters.uploadedBytes += bytes;
}

void fillBytes(Queue& queue, Memory& memory, std::uint8_t value, std::size_t bytes) {
    QueueState& state = *queue.state();
    guarded(state.device.get(), "clearing device memory", [&] {
        cl::Event event;  // a one-byte pattern is the fast one (PoCL)
        state.queue.enqueueFillBuffer<cl_uchar>(memory.buffer, value, 0, bytes, nullptr, &event);
        note(state, &Record::kernels, event);
    });
}

void copyBytes(Queue& queue, const Memory& from, Memory& to, std::size_t bytes) {
    if (bytes == 0) return;
    QueueState& state = *queue.state();
    guarded(state.device.get(), "copying device memory", [&] {
        cl::Event event;
        state.queue.enqueueCopyBuffer(from.buffer, to.buffer, 0, 0, bytes, nullptr, &event);
        note(state, &Record::kernels, event);
    });
}

std::string realOptions(const Queue& queue) { return queue.precision() == Precision::single ? "-DVITRAIL_SINGLE" : ""; }

CallReport resolve(const Record& record) {
    return guarded(record.device.get(), "reading times", [&] {
        CallReport report;
        double lastEnd = 0, firstQueued = 0;
        bool any = false;
        for (const auto* list : {&record.kernels, &record.uploads}) {
            if (!list->empty()) cl::Event::waitForEvents(*list);
            for (const cl::Event& event : *list) {
                const double ms = eventMs(event);
                (list == &record.kernels ? report.kernelMs : report.uploadMs) += ms;
                const double queued = 1e-6 * static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_QUEUED>());
                const double end = 1e-6 * static_cast<double>(event.getProfilingInfo<CL_PROFILING_COMMAND_END>());
                firstQueued = any ? std::min(firstQueued, queued) : queued;
                lastEnd = any ? std::max(lastEnd, end) : end;
                any = true;
            }
        }
        // Host time until the first command and after the call's end, device time between: the clocks need not agree.
        const double hostMs = milliseconds(record.end - record.begin);
        const double lead = any ? milliseconds(record.firstEnqueue - record.begin) : 0;
        report.wallMs = std::max(hostMs, lead + (lastEnd - firstQueued));
        report.buildMs = record.buildMs;
        report.deviceBytes = record.deviceBytes;
        report.device = record.device->text();
        report.singlePrecision = record.singlePrecision;
        return report;
    });
}

Call::Call(Queue& queue, std::string name) : queue_(queue), name_(std::move(name)), record_(std::make_shared<Record>()) {
    record_->device = queue.state()->device;
    record_->begin = record_->firstEnqueue = record_->end = std::chrono::steady_clock::now();
    record_->singlePrecision = queue.precision() == Precision::single;
    queue.state()->records.push_back(record_);
}

Call::~Call() {
    queue_.state()->queue.flush();
    record_->end = std::chrono::steady_clock::now();
    record_->deviceBytes = record_->device->counters.deviceBytes;
    queue_.state()->records.pop_back();
}

void Call::step(const char* step, double fraction) {
    QueueState& state = *queue_.state();
    if (!state.progress) return;
    queue_.finish();
    if (!state.progress(Progress{step, fraction})) throw Error(ErrorCode::cancelled, {"cancelled", "", name_, ""});
}

std::uint32_t Call::taskGroups() const { return std::max(64u, 32u * queue_.state()->device->info.computeUnits); }

Call::Spread Call::spreadOver(std::uint64_t count, std::uint32_t together) const {
    const DeviceInfo& info = queue_.state()->device->info;
    if (!info.cpu) return {together, 64};
    // Long enough runs to pay for a work-group (25 ns on PoCL), short enough for every unit to get many.
    const std::uint64_t share = count / (16ull * std::max(1u, info.computeUnits));
    return {(static_cast<std::uint32_t>(std::clamp<std::uint64_t>(share, 1, 64)) + together - 1) / together * together, 1};
}

const Buffer<std::uint32_t>& Call::kept(const std::string& name, std::uint64_t count,
                                        const std::function<void(Buffer<std::uint32_t>&)>& make) {
    std::map<std::string, Buffer<std::uint32_t>>& all = queue_.state()->kept;
    if (const auto found = all.find(name); found != all.end()) return found->second;
    Buffer<std::uint32_t> buffer = queue_.workspace().take<std::uint32_t>(count, name);
    make(buffer);
    return all.emplace(name, std::move(buffer)).first->second;
}

void* Call::beginLaunch(const Program& which, const char* kernel) {
    QueueState& state = *queue_.state();
    const std::string key = std::string(kernel) + " " + which.options;
    auto found = state.kernels.find(key);
    if (found == state.kernels.end()) {
        const auto start = std::chrono::steady_clock::now();
        found = guarded(state.device.get(), name_.c_str(), [&] {
            return state.kernels.emplace(key, cl::Kernel(program(*state.device, which.part, which.options), kernel)).first;
        });
        ++state.device->counters.kernelsCreated;
        const double ms = milliseconds(std::chrono::steady_clock::now() - start);
        for (const std::shared_ptr<Record>& record : state.records) record->buildMs += ms;
    }
    return &found->second;
}

void Call::setBytes(void* handle, std::uint32_t index, const void* value, std::size_t bytes) {
    guarded(record_->device.get(), name_.c_str(), [&] { static_cast<cl::Kernel*>(handle)->setArg(index, bytes, value); });
}

void Call::setMemory(void* handle, std::uint32_t index, const Memory* memory) {
    guarded(record_->device.get(), name_.c_str(), [&] {
        const cl_mem none = nullptr;
        static_cast<cl::Kernel*>(handle)->setArg(index, sizeof(cl_mem), memory != nullptr ? &memory->buffer() : &none);
    });
}

void Call::endLaunch(void* handle, const char* kernel, std::uint64_t count, std::uint32_t local) {
    if (count == 0) return;
    QueueState& state = *queue_.state();
    const std::string during = name_ + " (" + kernel + ")";
    guarded(state.device.get(), during.c_str(), [&] {
        cl::Event event;
        state.queue.enqueueNDRangeKernel(*static_cast<cl::Kernel*>(handle), cl::NullRange, cl::NDRange((count + local - 1) / local * local),
                                         cl::NDRange(local), nullptr, &event);
        note(state, &Record::kernels, event);
    });
    ++state.device->counters.launches;
}

void Call::fillMemory(Memory& memory, std::uint8_t byte, std::uint64_t bytes) { fillBytes(queue_, memory, byte, bytes); }
void Call::uploadMemory(Memory& memory, const void* values, std::uint64_t bytes) { writeBytes(queue_, memory, 0, values, bytes); }

}  // namespace detail

Queue::Queue(Device& device)
    : Queue(detail::guarded(device.state().get(), "making a command queue", [&] {
          return detail::makeQueueState(device.state(),
                                        cl::CommandQueue(device.state()->context, device.state()->device, CL_QUEUE_PROFILING_ENABLE));
      })) {}
Queue::Queue(std::shared_ptr<detail::QueueState> state) : state_(std::move(state)), workspace_(state_) {}
Queue::Queue(Queue&&) noexcept = default;
Queue& Queue::operator=(Queue&&) noexcept = default;
Queue::~Queue() {
    if (state_ && state_.use_count() <= 2) {  // own and the workspace's reference: no result is left
        try {
            state_->queue.finish();
        } catch (const cl::Error&) {  // the device is gone; there is nobody left to tell
        }
    }
}

void Queue::finish() {
    detail::guarded(state_->device.get(), "waiting for the device", [&] { state_->queue.finish(); });
}
Workspace& Queue::workspace() { return workspace_; }
DeviceInfo Queue::deviceInfo() const { return state_->device->info; }
std::uint64_t Queue::memoryLimit() const { return state_->device->memoryLimit; }
Counters Queue::counters() const { return Device(state_->device).counters(); }
void Queue::setStorage(Storage storage) { state_->storage = storage; }
Storage Queue::storage() const { return state_->storage; }
void Queue::setPrecision(Precision precision) { state_->precision = precision; }
Precision Queue::precision() const { return state_->device->info.fp64 ? state_->precision : Precision::single; }
void Queue::setProgress(std::function<bool(const Progress&)> progress) { state_->progress = std::move(progress); }

void Workspace::trim() { queue_->pool->trim(); }
std::uint64_t Workspace::pooledBytes() const { return queue_->pool->freeBytes(); }

}  // namespace v0
}  // namespace vitrail
