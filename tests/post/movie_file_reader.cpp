// SPDX-License-Identifier: GPL-3.0-or-later
#include "movie_file_reader.hpp"

#include <stdexcept>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace hilo::test {
namespace {

std::uint32_t u32(const std::string& b, size_t at) {
  std::uint32_t x = 0;
  for (size_t i = 0; i < 4; ++i) x = x << 8 | static_cast<unsigned char>(b.at(at + i));
  return x;
}

/// Visit the boxes of [from, to) and those inside containers.
template <class Visit>
void boxes(const std::string& b, size_t from, size_t to, int depth, Visit&& visit) {
  while (from + 8 <= to) {
    const size_t size = u32(b, from);
    const std::string name = b.substr(from + 4, 4);
    if (size < 8 || from + size > to) throw std::runtime_error("a box of " + std::to_string(size) + " bytes");
    visit(name, from + 8, depth);
    if (name == "moov" || name == "trak" || name == "mdia" || name == "minf" || name == "stbl")
      boxes(b, from + 8, from + size, depth + 1, visit);
    from += size;
  }
}

}  // namespace

MovieHeader movie_header(const std::string& bytes) {
  MovieHeader h;
  boxes(bytes, 0, bytes.size(), 0, [&](const std::string& name, size_t at, int depth) {
    if (depth == 0) h.top.push_back(name);
    if (name == "mvhd") h.duration = static_cast<double>(u32(bytes, at + 16)) / u32(bytes, at + 12);  // version 0
    if (name == "tkhd") h.width = static_cast<int>(u32(bytes, at + 76) >> 16), h.height = static_cast<int>(u32(bytes, at + 80) >> 16);
    if (name == "stsd") h.codec = bytes.substr(at + 12, 4);
    if (name == "stsz") h.frames = u32(bytes, at + 8);
  });
  return h;
}

std::vector<DecodedFrame> decoded(const std::string& path) {
  std::vector<DecodedFrame> frames;
  AVFormatContext* file = nullptr;
  if (avformat_open_input(&file, path.c_str(), nullptr, nullptr) < 0 || avformat_find_stream_info(file, nullptr) < 0)
    throw std::runtime_error(path + " is no movie");
  const AVStream* stream = file->streams[0];
  AVCodecContext* codec = avcodec_alloc_context3(avcodec_find_decoder(stream->codecpar->codec_id));
  avcodec_parameters_to_context(codec, stream->codecpar);
  avcodec_open2(codec, nullptr, nullptr);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  SwsContext* convert = sws_getContext(codec->width, codec->height, AV_PIX_FMT_YUV420P, codec->width, codec->height, AV_PIX_FMT_RGB24,
                                       SWS_BICUBIC, nullptr, nullptr, nullptr);
  const int* bt709 = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(convert, bt709, 0, bt709, 1, 0, 1 << 16, 1 << 16);
  const auto take = [&] {
    while (avcodec_receive_frame(codec, frame) == 0) {
      DecodedFrame f{codec->width, codec->height, static_cast<double>(frame->pts) * av_q2d(stream->time_base), {}};
      f.rgb.resize(3 * static_cast<size_t>(f.width) * static_cast<size_t>(f.height));
      auto* to = reinterpret_cast<std::uint8_t*>(f.rgb.data());
      const int stride = 3 * f.width;
      sws_scale(convert, frame->data, frame->linesize, 0, f.height, &to, &stride);
      frames.push_back(std::move(f));
    }
  };
  while (av_read_frame(file, packet) == 0) {
    avcodec_send_packet(codec, packet);
    av_packet_unref(packet);
    take();
  }
  avcodec_send_packet(codec, nullptr);
  take();
  sws_freeContext(convert);
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&codec);
  avformat_close_input(&file);
  return frames;
}

}  // namespace hilo::test
