#include "godot/hand/scene/shape_shelf.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include <godot_cpp/classes/worker_thread_pool.hpp>
#include <godot_cpp/variant/string.hpp>

namespace spidar {

namespace {

using godot::PhysicsServer3D;

// Largest difference of scales that share a cooked shape: the scale of a rotating body changes by
// rounding.
constexpr double kSameScale = 1e-4;
constexpr double kAboutSameScale = 0.05;
constexpr std::int64_t kKeptTicks = 600;
constexpr std::int64_t kKeptPieceTicks = 120;
constexpr std::int64_t kSweepTicks = 64;
// Largest number of jobs per source: a changing scale would otherwise start one in each tick.
constexpr int kMostJobsOfOne = 2;
// A shape waits one more tick between reads for each of these many elements that a read copies.
constexpr std::int64_t kElementsPerTick = 500;
constexpr std::int64_t kLongestWait = 600;

bool same_scale(const Vec3 &a, const Vec3 &b) noexcept {
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(a[axis] - b[axis]) > kSameScale * std::abs(b[axis])) {
            return false;
        }
    }
    return true;
}

// Returns an empty string when the shape can be cooked, else the reason.
std::string refusal(const ShapeData &data) {
    switch (data.numbers.type) {
    case PhysicsServer3D::SHAPE_SEPARATION_RAY:
        return "a separation ray has no surface; use another shape.";
    case PhysicsServer3D::SHAPE_SOFT_BODY:
        return "it belongs to a soft body; use a rigid body.";
    case PhysicsServer3D::SHAPE_CUSTOM:
        return "its type is custom; use a shape of Godot.";
    default:
        return data.readable ? ""
                             : "the physics server does not report its data; set the shape again.";
    }
}

} // namespace

ShapeShelf::~ShapeShelf() {
    for (const auto &job : jobs_) {
        job->unwanted.store(true, std::memory_order_relaxed);
    }
    for (const auto &job : jobs_) {
        godot::WorkerThreadPool::get_singleton()->wait_for_task_completion(job->task);
    }
}

void ShapeShelf::begin_tick() {
    ++tick_;
    if (!jobs_.empty()) {
        take_finished();
    }
    if (tick_ % kSweepTicks == 0) {
        let_go();
    }
}

std::shared_ptr<ShapeShelf::Source> ShapeShelf::find(const godot::RID &shape) {
    std::shared_ptr<Source> &place = sources_[shape.get_id()];
    if (place == nullptr) {
        place = std::make_shared<Source>();
        place->shape = shape;
        place->data = reader_.read(shape);
        place->next_look = tick_ + 1;
    }
    place->used_tick = tick_;
    return place;
}

void ShapeShelf::look_again(Source &source) {
    source.used_tick = tick_;
    if (tick_ < source.next_look) {
        return;
    }
    const DataChange change = reader_.read_again(source.shape, source.data);
    source.next_look = tick_ + 1;
    if (change == DataChange::changed) {
        ++source.version;
        ++source.bounds;
    } else if (change == DataChange::copied) {
        const ShapeNumbers &numbers = source.data.numbers;
        const std::int64_t many = numbers.point_count + numbers.height_count;
        source.next_look += std::min(many / kElementsPerTick, kLongestWait);
    }
}

Piece &ShapeShelf::cooked(Source &source, const Vec3 &scale) {
    const auto found =
        std::find_if(source.pieces.begin(), source.pieces.end(),
                     [&scale](const auto &piece) { return same_scale(scale, piece->scale); });
    if (found != source.pieces.end()) {
        Piece &piece = **found;
        piece.used_tick = tick_;
        if (piece.asked != source.version) {
            start(source, piece);
        }
        return piece;
    }
    auto piece = std::make_unique<Piece>();
    piece->scale = scale;
    piece->used_tick = tick_;
    stand_in(source, *piece);
    source.pieces.push_back(std::move(piece));
    start(source, *source.pieces.back());
    return *source.pieces.back();
}

// A large shape whose scale changes uses a finished shape of about the same scale.
void ShapeShelf::stand_in(const Source &source, Piece &piece) {
    double least = kAboutSameScale;
    for (const auto &other : source.pieces) {
        const Vec3 ratio = other->scale / piece.scale - Vec3(1.0);
        const double off = std::max({std::abs(ratio.x), std::abs(ratio.y), std::abs(ratio.z)});
        if (other->shape != nullptr && off < least) {
            least = off;
            piece.shape = other->shape;
        }
    }
}

void ShapeShelf::start(Source &source, Piece &piece) {
    const std::string reason = refusal(source.data);
    if (!reason.empty()) {
        CookResult refused;
        refused.status = Status::invalid_shape;
        refused.sentence = reason;
        put(piece, source.version, std::move(refused));
        return;
    }
    if (!is_large(source.data.numbers)) {
        put(piece, source.version, cook_shape(source.data.numbers, piece.scale));
        return;
    }
    if (source.jobs >= kMostJobsOfOne) {
        return; // asked again in the next tick
    }
    auto job = std::make_unique<Job>();
    job->data = source.data;
    job->scale = piece.scale;
    job->version = source.version;
    job->source = sources_[source.shape.get_id()];
    job->task = godot::WorkerThreadPool::get_singleton()->add_native_task(
        &ShapeShelf::run, job.get(), false, "SPIDAR-G: prepares a large shape");
    jobs_.push_back(std::move(job));
    piece.asked = source.version;
    ++source.jobs;
    ++counts_.cooking;
}

void ShapeShelf::run(void *job) {
    Job &mine = *static_cast<Job *>(job);
    try {
        if (mine.unwanted.load(std::memory_order_relaxed)) {
            return;
        }
        mine.bounds = bounds_of(mine.data.numbers);
        mine.result = cook_shape(mine.data.numbers, mine.scale);
    } catch (const std::exception &error) {
        mine.result.status = Status::invalid_shape;
        mine.result.sentence = std::string("it could not be prepared: ") + error.what();
    }
    mine.done.store(true, std::memory_order_release);
}

void ShapeShelf::put(Piece &piece, std::uint64_t version, CookResult result) {
    piece.version = version;
    piece.asked = std::max(piece.asked, version);
    piece.why_not = std::move(result.sentence);
    piece.told = false;
    piece.shape = std::move(result.shape);
    piece.state = piece.shape != nullptr ? PieceState::ready : PieceState::refused;
    ++(piece.shape != nullptr ? counts_.cooked : counts_.refused);
}

void ShapeShelf::take_finished() {
    const auto finished = [this](const std::unique_ptr<Job> &job) {
        if (!job->done.load(std::memory_order_acquire)) {
            return false;
        }
        godot::WorkerThreadPool::get_singleton()->wait_for_task_completion(job->task);
        --counts_.cooking;
        if (const auto source = job->source.lock()) {
            --source->jobs;
            if (source->version == job->version) {
                source->data.bounds = job->bounds;
                ++source->bounds;
            }
            for (const auto &piece : source->pieces) {
                if (job->version > piece->version && same_scale(job->scale, piece->scale)) {
                    put(*piece, job->version, std::move(job->result));
                    break;
                }
            }
        }
        return true;
    };
    jobs_.erase(std::remove_if(jobs_.begin(), jobs_.end(), finished), jobs_.end());
}

void ShapeShelf::let_go() {
    int held = 0;
    for (auto place = sources_.begin(); place != sources_.end();) {
        auto &[id, source] = *place;
        auto &pieces = source->pieces;
        const bool unused = source.use_count() == 1 && tick_ - source->used_tick > kKeptTicks;
        const auto old = [this](const std::unique_ptr<Piece> &piece) {
            return tick_ - piece->used_tick > kKeptPieceTicks;
        };
        if (pieces.size() > 1) {
            pieces.erase(std::remove_if(pieces.begin(), pieces.end(), old), pieces.end());
        }
        held += static_cast<int>(pieces.size());
        place = unused ? sources_.erase(place) : std::next(place);
    }
    counts_.held = held;
}

} // namespace spidar
