//! Ranks that are threads: every call, ranks that are lost, and calls that are wrong.

mod calls;

use std::collections::BTreeSet;
use std::thread::sleep;
use std::time::Duration;

use calls::{every_call, on_threads};
use piola_ranks::{Alone, Message, RankError, Ranks, Threads};
use proptest::prelude::*;

const SIZES: [usize; 5] = [1, 2, 3, 4, 7];

fn message(rank: usize, numbers: &[f64]) -> Message {
    Message { rank, numbers: numbers.to_vec() }
}

#[test]
fn every_call_gives_what_it_has_to() {
    assert_eq!(every_call(&Alone), Ok(()));
    for size in SIZES {
        assert_eq!(on_threads(size, |rank| every_call(&rank)), vec![Some(Ok(())); size]);
    }
    assert!(Threads::group(0).is_empty());
}

/// A call of each kind, by name.
type Call = (&'static str, fn(&Threads) -> Result<(), RankError>);

const CALLS: [Call; 6] = [
    ("exchange", |ranks| {
        let all = || (0..ranks.size()).map(|rank| message(rank, &[1.0, 2.0])).collect();
        let (send, mut receive): (Vec<Message>, Vec<Message>) = (all(), all());
        ranks.exchange(&send, &mut receive)
    }),
    ("add", |ranks| ranks.add(&mut [1, 2])),
    ("gather_to_all", |ranks| ranks.gather_to_all(&[1.0]).map(drop)),
    ("gather", |ranks| ranks.gather(&[1.0]).map(drop)),
    ("scatter", |ranks| ranks.scatter(&vec![vec![1.0]; ranks.size()]).map(drop)),
    ("broadcast", |ranks| ranks.broadcast(vec![1.0]).map(drop)),
];

/// Whether a rank can make a call although another one is lost: it needs nothing of it.
fn can_do_without(call: &str, rank: usize, lost: usize) -> bool {
    match call {
        "gather" => rank > 0,
        "scatter" | "broadcast" => rank == 0 || lost > 0,
        _ => false,
    }
}

/// A rank ends, or panics, before or while the others wait.
#[test]
fn a_lost_rank_is_told_to_all_that_wait_for_it() {
    for ((name, call), size) in CALLS.into_iter().flat_map(|call| SIZES.map(|size| (call, size))) {
        for (lost, panics, waits) in (0..size).flat_map(|lost| {
            [(lost, false, false), (lost, false, true), (lost, true, false), (lost, true, true)]
        }) {
            let results = on_threads(size, move |rank| {
                assert_eq!(call(&rank), Ok(()));
                if rank.rank() == lost {
                    if waits {
                        sleep(Duration::from_millis(2));
                    }
                    if panics {
                        std::panic::resume_unwind(Box::new("on purpose"));
                    }
                    return [Ok(()), Ok(())];
                }
                // All need the lost rank for the second one.
                [call(&rank), rank.gather_to_all(&[]).map(drop)]
            });
            let what = format!("{name} of {size} ranks, {lost} lost");
            for (rank, result) in results.into_iter().enumerate().filter(|(rank, _)| *rank != lost)
            {
                let [first, second] = result.expect("only the lost rank panics");
                let error = Err(RankError::Lost(lost));
                assert_eq!(second, error, "rank {rank}, later: {what}");
                let can = can_do_without(name, rank, lost) && first.is_ok();
                assert!(can || first == error, "rank {rank}: {what}: {first:?}");
            }
        }
    }
}

/// What a rank has said before it ended arrives.
#[test]
fn the_last_words_of_a_rank_arrive() {
    let heard = on_threads(3, |rank| {
        if rank.rank() == 0 {
            sleep(Duration::from_millis(20));
        }
        rank.gather(&[rank.rank() as f64])
    });
    assert_eq!(heard[0], Some(Ok(vec![vec![0.0], vec![1.0], vec![2.0]])));
}

/// A rank that waits for nobody does not go on for ever.
#[test]
fn a_rank_that_only_sends_hears_of_a_lost_one() {
    let heard = on_threads(2, |rank| match rank.rank() {
        0 => (0..).find_map(|_| {
            sleep(Duration::from_millis(1));
            rank.exchange(&[message(1, &[1.0])], &mut []).err()
        }),
        _ => None,
    });
    assert_eq!(heard[0], Some(Some(RankError::Lost(1))));
}

/// Rank 0 waits for 1, which waits for 2, which waits for 3, which is lost: none of them blames another one.
#[test]
fn the_rank_to_blame_is_named_to_all() {
    let heard = on_threads(4, |rank| match rank.rank() {
        3 => Ok(()),
        own => {
            let heard = rank.exchange(&[], &mut [message(own + 1, &[0.0])]);
            // The rank is there until all have heard of it.
            sleep(Duration::from_millis(20));
            assert_eq!(rank.add(&mut [1]), heard);
            heard
        }
    });
    assert_eq!(heard[..3], [const { Some(Err(RankError::Lost(3))) }; 3]);
}

/// The error of rank 1 of two, and that of rank 0, which then waits for it.
fn wrong(call: impl Fn(&Threads) -> Result<(), RankError> + Clone + Send + 'static) -> RankError {
    let heard = on_threads(2, move |rank| {
        let first = call(&rank);
        let second = rank.add(&mut [1]);
        if rank.rank() == 1 {
            assert_eq!(second, Err(RankError::Lost(1)), "rank 1 has left");
            return first;
        }
        second
    });
    assert_eq!(heard[0], Some(Err(RankError::Lost(1))));
    heard.into_iter().nth(1).flatten().and_then(Result::err).expect("rank 1 is wrong")
}

#[test]
fn wrong_calls_are_refused() {
    for (sent, expected) in [(3, 2), (2, 3), (0, 1), (1, 0)] {
        let error = wrong(move |ranks| match ranks.rank() {
            0 => ranks.exchange(&[message(1, &vec![1.0; sent])], &mut []),
            _ => ranks.exchange(&[], &mut [message(0, &vec![1.0; expected])]),
        });
        assert_eq!(error, RankError::Length { rank: 0, expected, got: sent });
    }
    let error = wrong(|ranks| match ranks.rank() {
        0 => ranks.broadcast(vec![1.0]).map(drop),
        _ => ranks.scatter(&[]).map(drop),
    });
    assert_eq!(error, RankError::Call { rank: 0, expected: "scatter", got: "broadcast" });
    let error = wrong(|ranks| match ranks.rank() {
        0 => Ok(()),
        _ => ranks.exchange(&[message(2, &[])], &mut []),
    });
    assert_eq!(error, RankError::Nobody { rank: 2, size: 2 });
    let error = wrong(|ranks| match ranks.rank() {
        0 => Ok(()),
        _ => ranks.exchange(&[], &mut [message(1, &[])]),
    });
    assert_eq!(error, RankError::Own { sent: 0, received: 1 });
}

#[test]
fn sums_of_different_lengths_are_refused() {
    let heard = on_threads(3, |rank| rank.add(&mut vec![1; 2 + rank.rank() / 2]));
    let length = RankError::Length { rank: 2, expected: 2, got: 3 };
    let lost = Some(Err(RankError::Lost(0)));
    assert_eq!(heard, [Some(Err(length)), lost.clone(), lost]);
}

#[test]
fn what_is_shared_out_has_a_part_for_each_rank() {
    let parts = [vec![1.0]];
    let heard = on_threads(2, move |rank| rank.scatter(&parts));
    let refused = Some(Err(RankError::Parts { expected: 2, got: 1 }));
    assert_eq!(heard, [refused, Some(Err(RankError::Lost(0)))]);
    assert_eq!(Alone.scatter(&[]), Err(RankError::Parts { expected: 1, got: 0 }));
}

#[test]
fn one_alone_refuses_what_several_refuse() {
    let length = RankError::Length { rank: 0, expected: 1, got: 2 };
    let exchange = |send: &[Message], receive: &mut [Message]| Alone.exchange(send, receive);
    assert_eq!(exchange(&[message(0, &[1.0, 2.0])], &mut [message(0, &[1.0])]), Err(length));
    assert_eq!(exchange(&[message(1, &[])], &mut []), Err(RankError::Nobody { rank: 1, size: 1 }));
    let own = RankError::Own { sent: 1, received: 0 };
    assert_eq!(exchange(&[message(0, &[])], &mut []), Err(own));
}

/// Messages of known lengths go round in the same memory.
#[test]
fn buffers_are_used_again() {
    let heard = on_threads(3, |rank| {
        let (before, next) = ((rank.rank() + 2) % 3, (rank.rank() + 1) % 3);
        let mut receive = [message(before, &[0.0; 100])];
        let mut places = BTreeSet::new();
        for _ in 0..200 {
            rank.exchange(&[message(next, &[1.0; 100])], &mut receive).unwrap();
            places.insert(receive[0].numbers.as_ptr() as usize);
        }
        places.len()
    });
    // A rank has heard of itself, through the others, of the round before the last: there are at most three of its
    // messages under way, and one buffer with their receiver.
    assert!(heard.iter().flatten().all(|&count| count <= 4), "{heard:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Any pattern of messages, of any length, arrives as it was sent.
    #[test]
    fn any_exchange_arrives(
        size in 1..6usize,
        pattern in prop::collection::vec((0..6usize, 0..6usize, 0..50usize), 0..40),
    ) {
        let heard = on_threads(size, move |rank| {
            let (own, size) = (rank.rank(), rank.size());
            let sent = || pattern.iter().map(|&(from, to, length)| (from % size, to % size, length));
            let numbers = |place: usize, length| vec![place as f64; length];
            let (mut send, mut receive, mut expected) = (vec![], vec![], vec![]);
            for (place, (from, to, length)) in sent().enumerate() {
                if from == own {
                    send.push(message(to, &numbers(place, length)));
                }
                if to == own {
                    receive.push(message(from, &vec![f64::NAN; length]));
                    expected.push(message(from, &numbers(place, length)));
                }
            }
            rank.exchange(&send, &mut receive).map(|()| receive == expected)
        });
        prop_assert_eq!(heard, vec![Some(Ok(true)); size]);
    }
}
