// SPDX-License-Identifier: GPL-2.0-or-later
// What a calibration learnt: from which datum, and what remains open because two parameters make up
// for each other.
#ifndef CALENDEM_PREDICT_LEARNT_H
#define CALENDEM_PREDICT_LEARNT_H

#include "predict/prediction.h"

namespace calendem {

/// A datum, left out: the draws are weighted by 1 / its probability given all others (importance
/// sampling leave-one-out, Gelfand, Dey and Chang 1992).
struct LeftOutDatum {
  Band without;      ///< the datum as predicted from the others, with its own errors
  double gain = 0.0; ///< information on the materials [nats]: Kullback-Leibler, with over without
  std::string parameter;  ///< that it moves most
  double shift = 0.0;     ///< of its score's mean, in standard deviations without the datum
  double effective = 0.0; ///< draws that carry this
};
/// For each datum; empty where there is only one.
std::vector<LeftOutDatum> left_out_data_of(const FilmBank &bank, const Calibration &calibration);

/// Two parameters whose scores are correlated.
struct TradeOff {
  std::string first, second;
  double correlation = 0.0;
};
/// The strongest first, as far as they are larger than `least`.
std::vector<TradeOff> trade_offs_of(const FilmBank &bank, const Calibration &calibration,
                                    double least = 0.3);

} // namespace calendem

#endif
