(** Positive numbers have roots, for powers with rational exponents. [root] is the positive one. *)

From Coq Require Import Reals Lra Lia.

Open Scope R_scope.

Lemma power_above x n : 0 < x -> x < (1 + x) ^ S n.
Proof.
  intros H. induction n as [|n IH]; [cbn; lra|].
  cbn [pow] in *. assert (0 < (1 + x) * (1 + x) ^ n) by lra.
  assert (0 < x * ((1 + x) * (1 + x) ^ n)) by (apply Rmult_lt_0_compat; assumption). lra.
Qed.

Lemma root_exists n x : 0 < x -> {y | 0 < y /\ y ^ S n = x}.
Proof.
  intros H. destruct (IVT (fun y => y ^ S n - x) 0 (1 + x)) as [y [B E]].
  - apply continuity_minus; [apply derivable_continuous, derivable_pow|apply continuity_const].
    intros a b. reflexivity.
  - lra.
  - rewrite pow_ne_zero by lia. lra.
  - pose proof (power_above x n H). lra.
  - exists y. split; [|lra]. destruct (Req_dec y 0) as [->|Hy]; [|lra].
    rewrite pow_ne_zero in E by lia. lra.
Qed.

(** The positive number whose n-th power is x, for x > 0 and n ≥ 1 (otherwise 0). *)
Definition root (n : nat) (x : R) : R :=
  match n, Rlt_dec 0 x with
  | S m, left H => proj1_sig (root_exists m x H)
  | _, _ => 0
  end.

Lemma root_is n x : (n <> 0)%nat -> 0 < x -> 0 < root n x /\ root n x ^ n = x.
Proof.
  intros Hn H. destruct n as [|n]; [contradiction|]. unfold root.
  destruct (Rlt_dec 0 x) as [P|P]; [|contradiction]. destruct (root_exists n x P) as [y Y]. exact Y.
Qed.
