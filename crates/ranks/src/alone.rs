//! A single rank.

use super::{Message, RankError, Ranks, check_exchange, check_length, check_parts};

/// The only rank of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Alone;

impl Ranks for Alone {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn exchange(&self, send: &[Message], receive: &mut [Message]) -> Result<(), RankError> {
        check_exchange(send, receive, 0, 1)?;
        for (sent, received) in send.iter().zip(receive) {
            check_length(0, received.numbers.len(), sent.numbers.len())?;
            received.numbers.copy_from_slice(&sent.numbers);
        }
        Ok(())
    }

    fn add(&self, _numbers: &mut [i64]) -> Result<(), RankError> {
        Ok(())
    }

    fn gather_to_all(&self, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError> {
        self.gather(own)
    }

    fn gather(&self, own: &[f64]) -> Result<Vec<Vec<f64>>, RankError> {
        Ok(vec![own.to_vec()])
    }

    fn scatter(&self, all: &[Vec<f64>]) -> Result<Vec<f64>, RankError> {
        check_parts(all, 1)?;
        Ok(all.concat())
    }

    fn broadcast(&self, said: Vec<f64>) -> Result<Vec<f64>, RankError> {
        Ok(said)
    }
}
