#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace beltgrinding {

/// What something was behind a step of a simulation: what it did since the snapshot before, and
/// what goes on from there. It never changes.
class Snapshot {
  public:
    virtual ~Snapshot() = default;
    virtual std::size_t bytes() const = 0;
    /// Both in one. `next`: the one after it, of the same owner.
    virtual std::shared_ptr<const Snapshot> joined(const Snapshot& next) const = 0;
};

/// What goes on from step to step of a simulation, and can become again what it was.
class Stateful {
  public:
    virtual ~Stateful() = default;
    /// Name and size: a snapshot fits what tells the same.
    virtual std::string kind() const = 0;
    /// Since the last call, or `restore`. `blocks`: those that may have changed since, ascending.
    virtual std::shared_ptr<const Snapshot> snapshot(std::span<const std::uint32_t> blocks) = 0;
    /// Becomes what it was behind the last of these, which follow one another from the beginning;
    /// of none, what it is. Before the first step.
    virtual void restore(std::span<const Snapshot* const> from) = 0;
};

/// A Stateful whose snapshots are `Data`: with `append(next)` and `bytes()`.
template <class Data, class Base = Stateful>
class Keeps : public Base {
  public:
    using Base::Base;

    std::shared_ptr<const Snapshot> snapshot(std::span<const std::uint32_t> blocks) final {
        return std::make_shared<const Kept>(take(blocks));
    }
    void restore(std::span<const Snapshot* const> from) final {
        std::vector<const Data*> parts;
        for (const Snapshot* one : from) parts.push_back(&static_cast<const Kept&>(*one).data);
        put(parts);
    }

  protected:
    /// As `snapshot` and `restore`.
    virtual Data take(std::span<const std::uint32_t> blocks) = 0;
    virtual void put(std::span<const Data* const> parts) = 0;

  private:
    struct Kept final : Snapshot {
        explicit Kept(Data kept) : data(std::move(kept)) {}
        std::size_t bytes() const override { return data.bytes(); }
        std::shared_ptr<const Snapshot> joined(const Snapshot& next) const override {
            Data both = data;
            both.append(static_cast<const Kept&>(next).data);
            return std::make_shared<const Kept>(std::move(both));
        }
        Data data;
    };
};

template <class T>
std::size_t bytes_of(const T& value) {
    if constexpr (requires { value.bytes(); }) {
        return value.bytes();
    } else {
        return sizeof(T);
    }
}

inline std::size_t bytes_of(const Eigen::ArrayXXd& values) {
    return sizeof(values) + static_cast<std::size_t>(values.size()) * sizeof(double);
}

template <class T>
std::size_t bytes_of(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

template <class T>
void append(std::vector<T>& to, std::span<const T> from) {
    to.insert(to.end(), from.begin(), from.end());
}

/// Data of which only the last counts.
template <class T>
struct Latest {
    T value;

    void append(const Latest& next) { value = next.value; }
    std::size_t bytes() const { return bytes_of(value); }
};

/// Data of a list that grows: what came since the snapshot before.
template <class T>
struct Since {
    std::vector<T> values;

    void append(const Since& next) { beltgrinding::append<T>(values, next.values); }
    std::size_t bytes() const { return bytes_of(values); }
};

/// Data of blocks: of each that may have changed, as it is now.
template <class T>
struct ByBlock {
    std::vector<std::uint32_t> blocks;  // ascending
    std::vector<T> values;

    ByBlock() = default;
    /// `of(block)`: its data.
    template <class Of>
    ByBlock(std::span<const std::uint32_t> numbers, Of of)
        : blocks(numbers.begin(), numbers.end()) {
        values.reserve(blocks.size());
        for (const std::uint32_t block : blocks) values.push_back(of(block));
    }
    /// Calls visit(block, data).
    template <class Visit>
    void each(Visit visit) const {
        for (std::size_t k = 0; k < blocks.size(); ++k) visit(blocks[k], values[k]);
    }
    void append(const ByBlock& next) {
        ByBlock both;
        std::set_union(blocks.begin(), blocks.end(), next.blocks.begin(), next.blocks.end(),
                       std::back_inserter(both.blocks));
        both.values.reserve(both.blocks.size());
        std::size_t here = 0, there = 0;
        for (const std::uint32_t block : both.blocks) {
            const bool old = here < blocks.size() && blocks[here] == block;
            const bool later = there < next.blocks.size() && next.blocks[there] == block;
            both.values.push_back(later ? next.values[there] : values[here]);
            here += old ? 1 : 0;
            there += later ? 1 : 0;
        }
        *this = std::move(both);
    }
    std::size_t bytes() const {
        std::size_t sum = bytes_of(blocks);
        for (const T& value : values) sum += bytes_of(value);
        return sum;
    }
};

/// Data of something that keeps nothing.
struct Nothing {
    void append(const Nothing&) {}
    std::size_t bytes() const { return 0; }
};

}  // namespace beltgrinding
