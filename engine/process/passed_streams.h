#pragma once
// Input and output that one process of ours hands to another.

#include <sys/socket.h>
#include <sys/uio.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>

namespace touchstone {

/// Descriptors of an input and an output, as one message of a SOCK_SEQPACKET socket: a byte, and they beside
/// it (SCM_RIGHTS, unix(7)). Any thread; allocates nothing.
class PassedStreams {
  public:
    using Descriptors = std::array<int, 2>;

    PassedStreams() {
        message_.msg_iov = &part_;
        message_.msg_iovlen = 1;
        message_.msg_control = beside_.data();
        message_.msg_controllen = beside_.size();
    }
    PassedStreams(const PassedStreams&) = delete;
    PassedStreams& operator=(const PassedStreams&) = delete;

    /// They stay the caller's. False where nobody can take them.
    [[nodiscard]] bool send(int socket, int input, int output) {
        const Descriptors both{input, output};
        cmsghdr* const header = CMSG_FIRSTHDR(&message_);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof both);
        std::memcpy(CMSG_DATA(header), both.data(), sizeof both);
        return untilDone([&] { return sendmsg(socket, &message_, MSG_NOSIGNAL); });
    }
    /// Waits for them; they are the caller's to close. None where no more will come.
    [[nodiscard]] std::optional<Descriptors> receive(int socket) {
        if (!untilDone([&] { return recvmsg(socket, &message_, MSG_CMSG_CLOEXEC); }))
            return std::nullopt;
        Descriptors both{};
        const cmsghdr* const header = CMSG_FIRSTHDR(&message_);
        if (header == nullptr || header->cmsg_len != CMSG_LEN(sizeof both))
            return std::nullopt;
        std::memcpy(both.data(), CMSG_DATA(header), sizeof both);
        return both;
    }

  private:
    /// Whether the one byte has gone.
    template <class Call>
    static bool untilDone(const Call& call) {
        ssize_t count = -1;
        do
            count = call();
        while (count < 0 && errno == EINTR);
        return count == 1;
    }

    char byte_ = 0;
    iovec part_{&byte_, sizeof byte_};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(Descriptors))> beside_{};
    msghdr message_{};
};

} // namespace touchstone
