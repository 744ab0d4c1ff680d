(** Finite sums over whole numbers: split, shifted, swapped, bounded. Expressions with sums along diagonals have a
    normal form, which takes as many steps as there are sums and sites. *)

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

(** Whether a site is a bead of the packing: parity and bounds. *)
Ltac Zify.zify_post_hook ::= Z.div_mod_to_equations.
Ltac site := unfold bead, contact in *; lia.

(** A step there and one back. *)
Ltac steps_back := rewrite ?Z.add_simpl_r, ?Z.sub_add.
Tactic Notation "steps_back" "in" hyp(H) := rewrite ?Z.add_simpl_r, ?Z.sub_add in H.
Tactic Notation "steps_back" "in" "*" := rewrite ?Z.add_simpl_r, ?Z.sub_add in *.

(** Comparisons of indices that follow, one way or the other, from what is supposed. *)
Ltac compare_indices :=
  repeat match goal with
  | |- context [(?x =? ?y)%Z] =>
      first [replace (x =? y)%Z with false by lia|replace (x =? y)%Z with true by lia]
  | |- context [(?x <=? ?y)%Z] =>
      first [replace (x <=? y)%Z with true by lia|replace (x <=? y)%Z with false by lia]
  end.

(** Decide every condition; what contradicts the hypotheses goes. *)
Ltac decide_conditions :=
  repeat match goal with
  | |- context [if ?b then _ else _] => let E := fresh "E" in destruct b eqn:E; try (exfalso; site)
  end.

(** ** One name for one thing *)

(** Values h(a, b) and h(c, d) at sites that are equal by what is supposed get one name. *)
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

Lemma Sum_opp low high f : Sum low high (fun m => - f m) = - Sum low high f.
Proof.
  rewrite <- (Rmult_1_l (Sum low high f)), Ropp_mult_distr_l, <- Sum_scale. apply Sum_eq; auto. intros. ring.
Qed.

(** Sums of terms that are all 0. *)
Ltac no_zero_sums :=
  repeat match goal with
  | |- context [Sum ?a ?b ?f] => rewrite (Sum_zero a b f) by (intros; cbv beta; ring)
  end.

(** Sums of sums and multiples become sums of one value each. *)
Ltac elementary_sums :=
  no_zero_sums;
  repeat (rewrite Sum_plus || rewrite Sum_minus || rewrite Sum_opp || rewrite Sum_scale
    || rewrite Sum_times || rewrite Sum_over);
  no_zero_sums.

(** ** The normal form of an expression that has sums along diagonals *)

(** The values of h along the diagonal a = c + u b, from layer 1 to n; below layer 1, taken away. *)
Definition sum_along (h : Z -> Z -> R) (c u n : Z) : R :=
  Sum 1 n (fun m => h (c + u * m)%Z m) - Sum (n + 1) 0 (fun m => h (c + u * m)%Z m).

Lemma along_step h c u n : sum_along h c u n = sum_along h c u (n - 1) + h (c + u * n)%Z n.
Proof.
  unfold sum_along. replace (n - 1 + 1)%Z with n by lia. destruct (Z.le_gt_cases 1 n) as [H|H].
  - rewrite (Sum_last 1 n), !(Sum_empty _ 0) by lia. ring.
  - rewrite !(Sum_empty 1), (Sum_first n 0) by lia. ring.
Qed.

Lemma along_back h c u n : sum_along h c u n = sum_along h c u (n + 1) - h (c + u * (n + 1))%Z (n + 1)%Z.
Proof. rewrite (along_step h c u (n + 1)). replace (n + 1 - 1)%Z with n by lia. ring. Qed.

Lemma along_none h c u : sum_along h c u 0 = 0.
Proof. unfold sum_along. rewrite !Sum_empty by lia. ring. Qed.

Lemma Sum_along low high f h x y u : (low <= high + 1)%Z -> (forall m, f m = h (x + u * m)%Z (y + m)%Z) ->
  Sum low high f = sum_along h (x - u * y) u (high + y) - sum_along h (x - u * y) u (low + y - 1).
Proof.
  intros H E.
  assert (A : forall n, (low <= n + 1)%Z ->
    Sum low n f = sum_along h (x - u * y) u (n + y) - sum_along h (x - u * y) u (low + y - 1)).
  { intros n Hn. replace n with (n + 1 - 1)%Z by lia. revert Hn.
    generalize (n + 1)%Z as k. intros k Hk. pattern k. apply (up_from _ low); [| |exact Hk].
    - rewrite Sum_empty by lia. replace (low - 1 + y)%Z with (low + y - 1)%Z by lia. ring.
    - intros m Hm IH. replace (m + 1 - 1)%Z with m by lia. rewrite Sum_last, IH, E by lia.
      rewrite (along_step _ _ _ (m + y)). replace (m + y - 1)%Z with (m - 1 + y)%Z by lia.
      replace (x - u * y + u * (m + y))%Z with (x + u * m)%Z by ring.
      replace (m + y)%Z with (y + m)%Z by lia. ring. }
  apply A, H.
Qed.

(** Whole numbers in one form: all of the context are named first, so that their order is the same. *)
Ltac zeros so_far :=
  match goal with
  | n : Z |- _ => lazymatch so_far with context [n] => fail | _ => zeros (so_far + 0 * n)%Z end
  | _ => so_far
  end.
Ltac in_normal_form e E :=
  let o := zeros 0%Z in
  eassert (E : e = _);
  [transitivity (o + e)%Z; [ring|ring_simplify; reflexivity]|].

(** Every sum as [sum_along], up to a layer without a number added; every site in normal form. *)
Definition site_value (h : Z -> Z -> R) (a b : Z) : R := h a b.
Definition sum_in_normal_form (h : Z -> Z -> R) (c u n : Z) : R := sum_along h c u n.

Lemma along_as h u c c' n n' : c = c' -> n = n' -> sum_along h c u n = sum_along h c' u n'.
Proof. intros -> ->. reflexivity. Qed.
Lemma along_named h u c c' n n' : c = c' -> n = n' -> sum_along h c u n = sum_in_normal_form h c' u n'.
Proof. intros -> ->. reflexivity. Qed.
Lemma value_as (h : Z -> Z -> R) a a' b b' : a = a' -> b = b' -> h a b = site_value h a' b'.
Proof. intros -> ->. reflexivity. Qed.

Ltac slope_of f x y :=
  match eval cbv beta in (f 1%Z) with
  | _ ?x1 ?y1 =>
      let _ := constr:(ltac:(lia) : (y1 = y + 1)%Z) in
      match constr:(Set) with
      | _ => let _ := constr:(ltac:(lia) : (x1 = x + 1)%Z) in constr:(1%Z)
      | _ => let _ := constr:(ltac:(lia) : (x1 = x - 1)%Z) in constr:((-1)%Z)
      | _ => let _ := constr:(ltac:(lia) : (x1 = x)%Z) in constr:(0%Z)
      end
  end.

Ltac sums_along :=
  repeat match goal with
  | |- context [Sum ?a ?b ?f] =>
      match eval cbv beta in (f 0%Z) with
      | ?h ?x ?y =>
          let u := slope_of f x y in
          rewrite (Sum_along a b f h x y u) by (solve [site] || (intros; cbv beta; f_equal; lia))
      end
  end.

Ltac other_side E := lazymatch type of E with _ = ?x => x end.
Ltac bounds_in_normal_form :=
  repeat match goal with
  | |- context [sum_along ?h ?c ?u ?n] =>
      let C := fresh in let N := fresh in
      in_normal_form c C; in_normal_form n N;
      let c' := other_side C in let n' := other_side N in
      lazymatch n' with
      | 0%Z => rewrite (along_as h u c c' n n' C N), (along_none h c' u)
      | Z.pos _ => rewrite (along_as h u c c' n n' C N), (along_step h c' u n')
      | Z.neg _ => rewrite (along_as h u c c' n n' C N), (along_back h c' u n')
      | (_ + Z.pos _)%Z => rewrite (along_as h u c c' n n' C N), (along_step h c' u n')
      | (_ - Z.pos _)%Z => rewrite (along_as h u c c' n n' C N), (along_back h c' u n')
      | _ => rewrite (along_named h u c c' n n' C N)
      end;
      clear C N
  end.
Ltac sites_in_normal_form :=
  repeat match goal with
  | |- context [?h ?a ?b] =>
      let T := type of (h a b) in unify T R;
      let A := type of a in unify A Z; let B := type of b in unify B Z;
      lazymatch h with site_value _ => fail | sum_in_normal_form _ _ => fail | _ => idtac end;
      let H := fresh in let K := fresh in
      in_normal_form a H; in_normal_form b K;
      let a' := other_side H in let b' := other_side K in
      rewrite (value_as h a a' b b' H K); clear H K
  end.
Ltac normal_form := elementary_sums; sums_along; bounds_in_normal_form; sites_in_normal_form.
