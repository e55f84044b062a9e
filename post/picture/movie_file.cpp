// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/picture/movie_file.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>
}

namespace hilo {
namespace {

int checked(int code, const char* what) {
  if (code >= 0) return code;
  char text[AV_ERROR_MAX_STRING_SIZE] = "";
  av_strerror(code, text, sizeof text);
  throw Error("movie", fmt::format("{}: {}", what, text), "", code == AVERROR(ENOMEM) ? Exit::resources : Exit::fault);
}

}  // namespace

struct MovieFile::Encoder {
  AVFormatContext* file = nullptr;
  AVCodecContext* codec = nullptr;
  SwsContext* convert = nullptr;
  AVFrame* frame = nullptr;
  AVPacket* packet = nullptr;
  AVStream* stream = nullptr;
  std::int64_t n = 0;

  ~Encoder() {
    if (file && file->pb) {
      std::uint8_t* bytes = nullptr;
      avio_close_dyn_buf(file->pb, &bytes);
      av_free(bytes);
      file->pb = nullptr;
    }
    sws_freeContext(convert);
    av_packet_free(&packet);
    av_frame_free(&frame);
    avcodec_free_context(&codec);
    avformat_free_context(file);
  }

  /// Packets that the encoder has ready go to the file.
  void drain() {
    for (;;) {
      const int got = avcodec_receive_packet(codec, packet);
      if (got == AVERROR(EAGAIN) || got == AVERROR_EOF) return;
      checked(got, "a frame could not be encoded");
      packet->duration = 1;
      av_packet_rescale_ts(packet, codec->time_base, stream->time_base);
      packet->stream_index = stream->index;
      checked(av_interleaved_write_frame(file, packet), "a frame could not be written");
    }
  }
};

MovieFile::MovieFile(int width, int height, double fps, size_t frames, int threads) : encoder_(std::make_unique<Encoder>()) {
  av_log_set_level(AV_LOG_ERROR);
  Encoder& e = *encoder_;
  const AVCodec* h264 = avcodec_find_encoder_by_name("libx264");
  if (!h264) throw Error("movie", "libavcodec has no encoder for H.264", "install libavcodec59 and libx264-164 of Debian", Exit::resources);
  checked(avformat_alloc_output_context2(&e.file, nullptr, "mp4", nullptr), "no MP4 files");
  e.stream = avformat_new_stream(e.file, nullptr);
  e.codec = avcodec_alloc_context3(h264);
  e.frame = av_frame_alloc();
  e.packet = av_packet_alloc();
  if (!e.stream || !e.codec || !e.frame || !e.packet) throw std::bad_alloc();
  AVCodecContext& c = *e.codec;
  c.width = width, c.height = height;
  c.pix_fmt = AV_PIX_FMT_YUV420P;
  c.framerate = av_d2q(fps, 1001000);
  c.time_base = av_inv_q(c.framerate);
  c.gop_size = std::max(1, static_cast<int>(fps));  // a player can jump to every second
  c.max_b_frames = 0;
  c.thread_count = threads;
  c.color_range = AVCOL_RANGE_MPEG;
  c.color_primaries = AVCOL_PRI_BT709, c.color_trc = AVCOL_TRC_BT709, c.colorspace = AVCOL_SPC_BT709;
  c.flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  av_opt_set(c.priv_data, "preset", "fast", 0);
  av_opt_set(c.priv_data, "crf", "18", 0);  // thin lines and letters stay sharp
  av_opt_set(c.priv_data, "tune", "animation", 0);
  checked(avcodec_open2(&c, h264, nullptr), "the H.264 encoder does not start");
  checked(avcodec_parameters_from_context(e.stream->codecpar, &c), "no stream");
  e.stream->time_base = c.time_base;
  e.stream->avg_frame_rate = c.framerate;
  e.frame->format = c.pix_fmt, e.frame->width = width, e.frame->height = height;
  checked(av_frame_get_buffer(e.frame, 0), "no frame");
  e.convert =
      sws_getContext(width, height, AV_PIX_FMT_RGB24, width, height, c.pix_fmt, SWS_BICUBIC | SWS_ACCURATE_RND, nullptr, nullptr, nullptr);
  if (!e.convert) throw std::bad_alloc();
  const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(e.convert, bt709, 1, bt709, 0, 0, 1 << 16, 1 << 16);
  checked(avio_open_dyn_buf(&e.file->pb), "no memory for the movie");
  AVDictionary* options = nullptr;
  av_dict_set_int(&options, "moov_size", static_cast<std::int64_t>(4096 + 32 * frames), 0);
  const int begun = avformat_write_header(e.file, &options);
  av_dict_free(&options);
  checked(begun, "no MP4 header");
}

MovieFile::~MovieFile() = default;

void MovieFile::add(const std::string& pixels) {
  Encoder& e = *encoder_;
  checked(av_frame_make_writable(e.frame), "no frame");
  const auto* rows = reinterpret_cast<const std::uint8_t*>(pixels.data());
  const int stride = 3 * e.codec->width;
  sws_scale(e.convert, &rows, &stride, 0, e.codec->height, e.frame->data, e.frame->linesize);
  e.frame->pts = e.n++;
  checked(avcodec_send_frame(e.codec, e.frame), "a frame was refused");
  e.drain();
}

std::string MovieFile::finish() {
  Encoder& e = *encoder_;
  checked(avcodec_send_frame(e.codec, nullptr), "the last frames were refused");
  e.drain();
  checked(av_write_trailer(e.file), "no MP4 table of contents");
  std::uint8_t* bytes = nullptr;
  const int size = avio_close_dyn_buf(e.file->pb, &bytes);
  e.file->pb = nullptr;
  std::string out(reinterpret_cast<const char*>(bytes), static_cast<size_t>(size));
  av_free(bytes);
  return out;
}

}  // namespace hilo
