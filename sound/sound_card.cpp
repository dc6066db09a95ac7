#include "sound/sound_card.h"

#include "engine/core/error.h"
#include "engine/core/float_mode.h"

#include <alsa/asoundlib.h>
#include <jack/jack.h>
#include <portaudio.h>

#include <chrono>
#include <exception>
#include <thread>
#include <utility>

namespace touchstone {

namespace {

constexpr double kUsualRate = 48000.0; // frames per second
constexpr const char* kNoCard = "there is no sound card";
constexpr const char* kGone = "the sound card is gone";
constexpr const char* kPlugIn = "plug in or switch on a sound card, then switch the sound on again";
constexpr double kAskedLatency = 0.012; // s, requested from the card, which may take more

void sayNothing(const char*, int, const char*, int, const char*, ...) {}

/// ALSA and JACK print every missing item on stderr; relevant errors come as error codes.
void hush() {
    snd_lib_error_set_handler(sayNothing);
    jack_set_error_function([](const char*) {});
    jack_set_info_function([](const char*) {});
}

/// Without any output in ALSA's configuration PortAudio 19.6 ends the program by an assertion.
bool alsaIsConfigured() {
    snd_config_t* outputs = nullptr;
    return snd_config_update() >= 0 && snd_config_search(snd_config, "pcm", &outputs) >= 0;
}

[[noreturn]] void fail(const std::string& problem) {
    throw Error("sound", "", problem, kPlugIn);
}

bool ready(const auto& future) {
    return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

} // namespace

/// A PortAudio session with one open stream.
class SoundCard::Stream {
  public:
    explicit Stream(SoundCard& card) {
        hush();
        if (!alsaIsConfigured())
            fail(kNoCard);
        if (const PaError error = Pa_Initialize(); error != paNoError)
            fail(Pa_GetErrorText(error));
        try {
            open(card);
        } catch (...) {
            Pa_Terminate();
            throw;
        }
    }
    ~Stream() {
        Pa_StopStream(stream_);
        Pa_CloseStream(stream_);
        Pa_Terminate();
    }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    [[nodiscard]] SoundSource& source() { return *source_; }
    [[nodiscard]] SoundPlayer* player() { return dynamic_cast<SoundPlayer*>(source_.get()); } // null: another
    [[nodiscard]] const std::string& name() const { return name_; }
    /// False once the card is gone: PortAudio's thread has ended.
    [[nodiscard]] bool active() const { return Pa_IsStreamActive(stream_) == 1; }
    [[nodiscard]] double cardLatency() const {
        const PaStreamInfo* info = Pa_GetStreamInfo(stream_);
        return info != nullptr ? info->outputLatency : 0.0;
    }

  private:
    void open(SoundCard& card) {
        const PaDeviceIndex device = Pa_GetDefaultOutputDevice();
        const PaDeviceInfo* info = device != paNoDevice ? Pa_GetDeviceInfo(device) : nullptr;
        if (info == nullptr)
            fail(kNoCard);
        name_ = info->name;
        PaStreamParameters parameters{};
        parameters.device = device;
        parameters.channelCount = 2;
        parameters.sampleFormat = paFloat32;
        parameters.suggestedLatency = std::max(kAskedLatency, info->defaultLowOutputLatency);
        const bool usual = Pa_IsFormatSupported(nullptr, &parameters, kUsualRate) == paFormatIsSupported;
        const double rate = usual ? kUsualRate : info->defaultSampleRate;
        source_ = card.make_(rate);
        if (card.feed_ != nullptr) {
            for (SoundTick old; card.feed_->pop(old);) {
            }
            card.feed_->listen(true);
        }
        PaError error = Pa_OpenStream(&stream_, nullptr, &parameters, rate, paFramesPerBufferUnspecified,
                                      paNoFlag, &Stream::play, source_.get());
        if (error == paNoError) {
            error = Pa_StartStream(stream_);
            if (error != paNoError)
                Pa_CloseStream(stream_);
        }
        if (error != paNoError)
            fail(name_ + ": " + Pa_GetErrorText(error));
    }

    static int play(const void*, void* output, unsigned long frames, const PaStreamCallbackTimeInfo*,
                    PaStreamCallbackFlags, void* source) {
        enterFloatMode();
        static_cast<SoundSource*>(source)->fill({static_cast<SoundFrame*>(output), frames});
        return paContinue;
    }

    std::unique_ptr<SoundSource> source_;
    PaStream* stream_ = nullptr;
    std::string name_;
};

SoundCard::SoundCard(SoundFeed& feed)
    : feed_(&feed), make_([&feed](double rate) { return std::make_unique<SoundPlayer>(feed, rate); }) {}

SoundCard::SoundCard(std::function<std::unique_ptr<SoundSource>(double)> source) : make_(std::move(source)) {}

void SoundCard::listen(bool on) {
    if (feed_ != nullptr)
        feed_->listen(on);
}

SoundCard::~SoundCard() {
    listen(false);
    if (opening_.valid())
        opening_.wait();
    if (closing_.valid())
        closing_.wait();
}

void SoundCard::update(bool on, float volume) {
    if (ready(closing_))
        closing_.get();
    if (ready(opening_)) {
        try {
            stream_ = opening_.get();
            name_ = stream_->name();
            state_ = State::Playing;
        } catch (const std::exception& error) {
            problem_ = error.what();
            state_ = State::Failed;
            listen(false);
        }
    }
    if (state_ == State::Playing && !stream_->active()) {
        problem_ = Error("sound", "", kGone, kPlugIn).what();
        state_ = State::Failed;
        close(std::chrono::milliseconds(0));
    }
    if (stream_ != nullptr)
        stream_->source().setVolume(on ? volume : 0.0f);
    if (on && state_ == State::Off && !closing_.valid()) {
        state_ = State::Opening;
        opening_ = std::async(std::launch::async, [this] { return std::make_shared<Stream>(*this); });
    } else if (!on && state_ == State::Failed) {
        state_ = State::Off;
    } else if (!on && state_ == State::Playing) {
        state_ = State::Off;
        close(std::chrono::milliseconds(80)); // until it has faded out
    }
}

/// On its own thread: a card may take long.
void SoundCard::close(std::chrono::milliseconds after) {
    closing_ =
        std::async(std::launch::async, [this, after, stream = std::exchange(stream_, nullptr)]() mutable {
            std::this_thread::sleep_for(after);
            stream.reset();
            listen(false);
        });
}

void SoundCard::interrupt() {
    if (stream_ != nullptr && stream_->player() != nullptr)
        stream_->player()->interrupt();
}

SoundPlayer::Figures SoundCard::figures() const {
    if (stream_ == nullptr || stream_->player() == nullptr)
        return {};
    SoundPlayer::Figures figures = stream_->player()->figures();
    figures.latency += stream_->cardLatency();
    return figures;
}

} // namespace touchstone
