(** Finite sums over whole numbers. *)

From Coq Require Import ZArith Reals Lia Lra.
From ForceDiffusion Require Import Model.

Open Scope R_scope.

Lemma sum_from_ext low count f g :
  (forall m, (low <= m < low + Z.of_nat count)%Z -> f m = g m) ->
  sum_from low count f = sum_from low count g.
Proof.
  induction count as [|n IH]; intros H; [reflexivity|].
  cbn [sum_from]. rewrite IH by (intros; apply H; lia). rewrite (H (low + Z.of_nat n)%Z) by lia.
  reflexivity.
Qed.

Lemma Sum_empty low high f : (high < low)%Z -> Sum low high f = 0.
Proof. intros H. unfold Sum. replace (Z.to_nat (high - low + 1)) with O by lia. reflexivity. Qed.

Lemma Sum_eq low high low' high' f g :
  low = low' -> high = high' -> (forall m, (low <= m <= high)%Z -> f m = g m) ->
  Sum low high f = Sum low' high' g.
Proof. intros <- <- H. apply sum_from_ext. intros m Hm. apply H. lia. Qed.

Lemma Sum_last low high f : (low <= high)%Z -> Sum low high f = Sum low (high - 1) f + f high.
Proof.
  intros H. unfold Sum.
  replace (Z.to_nat (high - low + 1)) with (S (Z.to_nat (high - 1 - low + 1))) by lia.
  cbn [sum_from]. do 2 f_equal. lia.
Qed.

Lemma Sum_one low f : Sum low low f = f low.
Proof. rewrite Sum_last, Sum_empty by lia. ring. Qed.

(** Induction on the upper bound: from the empty sum on. *)
Lemma up_from (P : Z -> Prop) low :
  P low -> (forall n, (low <= n)%Z -> P n -> P (n + 1)%Z) -> forall n, (low <= n)%Z -> P n.
Proof.
  intros H0 HS n Hn. replace n with (low + Z.of_nat (Z.to_nat (n - low)))%Z by lia.
  induction (Z.to_nat (n - low)) as [|k IH].
  - replace (low + Z.of_nat 0)%Z with low by lia. exact H0.
  - replace (low + Z.of_nat (S k))%Z with (low + Z.of_nat k + 1)%Z by lia. apply HS; [lia|exact IH].
Qed.

Lemma down_from (P : Z -> Prop) high :
  P high -> (forall n, (n < high)%Z -> P (n + 1)%Z -> P n) -> forall n, (n <= high)%Z -> P n.
Proof.
  intros H0 HS n Hn. replace n with (high - (high - n))%Z by lia.
  apply (up_from (fun m => P (high - m)%Z) 0); [replace (high - 0)%Z with high by lia; exact H0| |lia].
  intros m Hm IH. apply HS; [lia|]. replace (high - (m + 1) + 1)%Z with (high - m)%Z by lia. exact IH.
Qed.

Lemma Sum_induction (low high : Z) (P : Z -> Prop) :
  (forall n, (n < low)%Z -> P n) -> (forall n, (low <= n)%Z -> P (n - 1)%Z -> P n) -> P high.
Proof.
  intros H0 HS. destruct (Z.lt_ge_cases high low) as [H|H]; [apply H0, H|].
  replace high with (high + 1 - 1)%Z by lia.
  apply (up_from (fun m => P (m - 1)%Z) low); [apply H0; lia| |lia].
  intros n Hn IH. apply HS; [lia|]. replace (n + 1 - 1 - 1)%Z with (n - 1)%Z by lia. exact IH.
Qed.

Ltac sum_induction low high :=
  pattern high; apply (Sum_induction low);
  [let n := fresh "n" in let H := fresh "Hn" in intros n H; rewrite ?Sum_empty by lia
  |let n := fresh "n" in let H := fresh "Hn" in let IH := fresh "IH" in intros n H IH].

Lemma Sum_zero low high f : (forall m, (low <= m <= high)%Z -> f m = 0) -> Sum low high f = 0.
Proof.
  pattern high. apply (Sum_induction low); intros n Hn; [intros _; apply Sum_empty; lia|].
  intros IH H. rewrite Sum_last, IH, H by (intros; try apply H; lia). ring.
Qed.

Lemma Sum_plus low high f g :
  Sum low high (fun m => f m + g m) = Sum low high f + Sum low high g.
Proof. sum_induction low high; [ring|]. rewrite !(Sum_last low n) by lia. rewrite IH. ring. Qed.

Lemma Sum_scale low high a f : Sum low high (fun m => a * f m) = a * Sum low high f.
Proof. sum_induction low high; [ring|]. rewrite !(Sum_last low n) by lia. rewrite IH. ring. Qed.

Lemma Sum_times low high a f : Sum low high (fun m => f m * a) = Sum low high f * a.
Proof. rewrite (Rmult_comm _ a), <- Sum_scale. apply Sum_eq; auto. intros. ring. Qed.

Lemma Sum_swap low high low' high' (f : Z -> Z -> R) :
  Sum low high (fun m => Sum low' high' (fun n => f m n)) =
  Sum low' high' (fun n => Sum low high (fun m => f m n)).
Proof.
  sum_induction low high.
  - symmetry. apply Sum_zero. intros. apply Sum_empty. lia.
  - rewrite (Sum_last low n) by lia. rewrite IH, <- Sum_plus. apply Sum_eq; auto.
    intros m Hm. rewrite (Sum_last low n) by lia. reflexivity.
Qed.

Lemma Sum_over low high a f : Sum low high (fun m => f m / a) = Sum low high f / a.
Proof. unfold Rdiv. rewrite <- (Rmult_comm (/ a)), <- Sum_scale. apply Sum_eq; auto. intros. ring. Qed.

Lemma Sum_minus low high f g :
  Sum low high (fun m => f m - g m) = Sum low high f - Sum low high g.
Proof. sum_induction low high; [ring|]. rewrite !(Sum_last low n) by lia. rewrite IH. ring. Qed.

Lemma Sum_first low high f : (low <= high)%Z -> Sum low high f = f low + Sum (low + 1) high f.
Proof.
  intros H. revert H. pattern high. apply (Sum_induction low); intros n Hn; [lia|].
  intros IH _. rewrite (Sum_last low n) by lia.
  destruct (Z.eq_dec low n) as [<-|Hne].
  - rewrite !Sum_empty by lia. ring.
  - rewrite IH by lia. rewrite (Sum_last (low + 1) n) by lia. ring.
Qed.

Lemma Sum_shift low high by_ f :
  Sum low high (fun m => f (m + by_)%Z) = Sum (low + by_) (high + by_) f.
Proof.
  sum_induction low high; [ring|].
  rewrite (Sum_last low n), (Sum_last (low + by_) (n + by_)) by lia. rewrite IH.
  do 2 f_equal. lia.
Qed.

Lemma Sum_next low high f : Sum (low + 1) high f = Sum low (high - 1) (fun m => f (m + 1)%Z).
Proof. rewrite (Sum_shift low (high - 1) 1 f). apply Sum_eq; [lia|lia|auto]. Qed.

Lemma Sum_split low mid high f : (low <= mid + 1)%Z -> (mid <= high)%Z ->
  Sum low high f = Sum low mid f + Sum (mid + 1) high f.
Proof.
  intros H1 H2. revert H2. pattern high. apply (Sum_induction (mid + 1)); intros n Hn.
  - intros H. replace n with mid by lia. rewrite (Sum_empty (mid + 1)) by lia. ring.
  - intros IH _. rewrite (Sum_last low n), (Sum_last (mid + 1) n) by lia. rewrite IH by lia. ring.
Qed.

Lemma Sum_le low high f g : (forall m, (low <= m <= high)%Z -> f m <= g m) ->
  Sum low high f <= Sum low high g.
Proof.
  pattern high. apply (Sum_induction low).
  - intros n Hn _. rewrite !Sum_empty by lia. apply Rle_refl.
  - intros n Hn IH H. rewrite !(Sum_last low n) by lia.
    apply Rplus_le_compat; [apply IH; intros; apply H; lia|apply H; lia].
Qed.

Lemma Sum_abs low high f : Rabs (Sum low high f) <= Sum low high (fun m => Rabs (f m)).
Proof.
  sum_induction low high; [rewrite Rabs_R0; apply Rle_refl|].
  rewrite !(Sum_last low n) by lia. eapply Rle_trans; [apply Rabs_triang|]. lra.
Qed.

Lemma Sum_const low high a : (low <= high + 1)%Z ->
  Sum low high (fun _ => a) = IZR (high - low + 1) * a.
Proof.
  pattern high. apply (Sum_induction low); intros n Hn.
  - intros H. rewrite Sum_empty by lia. replace (n - low + 1)%Z with 0%Z by lia. ring.
  - intros IH _. rewrite (Sum_last low n), IH by lia.
    rewrite !plus_IZR, !minus_IZR. ring.
Qed.

(** ** One name for one thing *)

(** Values h(a, b) and h(c, d) at sites that are equal by [lia] get one name; so do sums that are
    equal term by term. What is left is for [ring] and [field]. *)
Ltac same_values :=
  repeat match goal with
  | |- context [?h ?a ?b] =>
      let T := type of (h a b) in unify T R;
      let A := type of a in unify A Z; let B := type of b in unify B Z;
      match goal with
      | |- context [h ?c ?d] =>
          first [constr_eq a c; constr_eq b d; fail 1
                |replace (h a b) with (h c d) by (apply f_equal2; lia)]
      end
  end.

Ltac same_sums :=
  repeat match goal with
  | |- context [Sum ?a ?b ?f] =>
      match goal with
      | |- context [Sum ?c ?d ?g] =>
          first [constr_eq a c; constr_eq b d; constr_eq f g; fail 1
                |replace (Sum a b f) with (Sum c d g)
                   by (apply Sum_eq; [lia|lia|intros; cbv beta; same_values; ring])]
      end
  end.

(** Sums of terms that are all 0. *)
Ltac no_zero_sums :=
  repeat match goal with
  | |- context [Sum ?a ?b ?f] => rewrite (Sum_zero a b f) by (intros; cbv beta; ring)
  end.
